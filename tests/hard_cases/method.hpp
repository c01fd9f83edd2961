// SPDX-License-Identifier: MIT
//
// The two extensions as ways to the same thing: the fragments of each sample, in order of depth.

#pragma once

#include "tests/hard_cases/layers.hpp"
#include "tests/hard_cases/scene.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace kb::hard
{

struct Shape {
    int k = 8;
    int samples = 0; ///< 0: not multisampled.
    GLenum func = GL_LESS;
    GLenum depth_format = GL_DEPTH_COMPONENT32F;
    Size size = usual_size;

    /// Depths of empty layers.
    double empty_depth() const { return func == GL_GREATER || func == GL_GEQUAL ? 0.0 : 1.0; }
};

/// What one pass over the geometry left.
struct Pass {
    Layers layers;
    bool overflow = false; ///< As the driver tells it.
};

enum class Direction { front_to_back, back_to_front };

/// What can go wrong in a driver, done to one sample of the first drawing that has enough layers: a
/// test of the tests.
enum class Flaw {
    none,
    lost_layer,     ///< The nearest fragment is missing.
    swapped_layers, ///< The two nearest stand in each other's place.
};

class Method
{
public:
    using Draw = std::function<void()>;

    virtual ~Method() = default;
    Method(const Method &) = delete;
    Method &operator=(const Method &) = delete;

    virtual std::string_view name() const = 0;

    /// Whether a further pass finds what is behind the last layer.
    virtual bool continues() const = 0;

    /// Passes over the geometry until nothing is left, but no more than `max_passes`.
    virtual std::vector<Pass> draw_passes(const Shape &shape, int max_passes, const Draw &draw) = 0;

    /// All fragments of each sample in single precision. `draw` draws them in that direction.
    virtual std::vector<Composite> compose(const Shape &shape, Direction direction,
                                           const Draw &draw) = 0;

    /// Why a shape is beyond the method, or nothing.
    virtual std::string why_not(const Shape &shape) const = 0;

    Layers draw(const Shape &shape, const Draw &draw)
    {
        return draw_passes(shape, 1, draw).front().layers;
    }

    void set_flaw(Flaw flaw) { flaw_ = flaw; }

    /// The flaw, for what is drawn by other means than this: it is applied then.
    Flaw take_flaw() { return std::exchange(flaw_, Flaw::none); }

    /// Of all layers that were drawn: the same if all bits were the same.
    std::uint64_t digest() const { return digest_; }

protected:
    Method() = default;

    /// Applies the flaw, and adds to the digest.
    Layers deliver(Layers layers);

private:
    Flaw flaw_ = Flaw::none; ///< Still to be applied.
    std::uint64_t digest_ = 0xcbf29ce484222325;
};

std::unique_ptr<Method> make_peeling(const Gl &gl);
std::unique_ptr<Method> make_program(const Gl &gl);

} // namespace kb::hard
