// SPDX-License-Identifier: MIT
//
// Ways to draw a translucent scene.

#pragma once

#include "lib/io/image.hpp"
#include "programs/kbuffer_program.hpp"
#include "transparency/scene.hpp"

#include <memory>
#include <vector>

namespace kb
{

/// One of the k layers that a method has kept. Where there is no fragment, depth is 1.
struct Layer {
    ImageRgbaF color;
    ImageF depth;
};

struct MethodOptions {
    Size size;
    int k = 8;
    EntryLayout layout = EntryLayout::packed;
    float alpha = 0.4F; ///< Of all fragments, for layouts without alpha.
    glm::vec3 background{1.0F};
};

class Method
{
public:
    virtual ~Method() = default;

    /// Draws the scene: once, or once for each layer.
    virtual void capture(const Scene &scene, const OrbitCamera &camera) = 0;

    /// Composes what was captured, front to back, over the background, into color attachment 0 of
    /// the framebuffer.
    virtual void resolve(GLuint framebuffer) = 0;

    /// The layers that were captured, nearest first. None for methods without.
    virtual std::vector<Layer> read_layers() const { return {}; }

    virtual int geometry_passes() const { return 1; }
    virtual int bytes_per_pixel() const = 0;
};

/// "kbuffer": one pass, GL_MESA_kbuffer_program.
Result<std::unique_ptr<Method>> make_kbuffer_method(const Gl &gl, const MethodOptions &options);

/// "peeling": one pass, GL_MESA_depth_peeling.
Result<std::unique_ptr<Method>> make_peeling_method(const Gl &gl, const MethodOptions &options);

/// "classic-peeling": k passes, each keeps the nearest fragments behind those of the last one.
Result<std::unique_ptr<Method>> make_classic_peeling_method(const Gl &gl,
                                                            const MethodOptions &options);

/// "unsorted": one pass of blending in the order of drawing, which is wrong.
Result<std::unique_ptr<Method>> make_unsorted_method(const Gl &gl, const MethodOptions &options);

} // namespace kb
