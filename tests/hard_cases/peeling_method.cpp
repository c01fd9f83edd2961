// SPDX-License-Identifier: MIT
//
// GL_MESA_depth_peeling.

#include "tests/hard_cases/method.hpp"
#include "tests/hard_cases/model.hpp"

#include "bench/gl_scene.hpp"
#include "lib/gl/depth_peeling.hpp"

namespace kb::hard
{

using bench::must;

namespace
{

class PeelingMethod final : public Method
{
public:
    explicit PeelingMethod(const Gl &gl) : gl_(gl) {}

    std::string_view name() const override { return "depth-peeling"; }
    bool continues() const override { return true; }
    std::string why_not(const Shape &) const override { return {}; }

    std::vector<Pass> draw_passes(const Shape &shape, int max_passes, const Draw &draw) override
    {
        const LayerReader reader(gl_, shape.size, shape.samples);
        auto peeling = must(DepthPeeling::make(gl_, {.size = shape.size,
                                                     .count = shape.k,
                                                     .func = shape.func,
                                                     .depth_format = shape.depth_format,
                                                     .color_formats = {GL_RGBA32F},
                                                     .samples = shape.samples}));
        must(peeling.restart());
        std::vector<Pass> passes;
        for (;;) {
            peeling.clear();
            gl_.Enable(GL_DEPTH_PEELING_MESA);
            draw();
            gl_.Disable(GL_DEPTH_PEELING_MESA);
            must(check_gl(gl_, "peeling"));
            passes.push_back({deliver(read(peeling, reader, shape)), peeling.overflow()});
            if (!passes.back().overflow || static_cast<int>(passes.size()) == max_passes)
                return passes;
            must(peeling.advance());
        }
    }

    /// The layers do not depend on the order of drawing: the composite is made of them.
    std::vector<Composite> compose(const Shape &shape, Direction direction,
                                   const Draw &draw) override
    {
        constexpr int many = 1000;
        std::vector<Composite> composites;
        for (const auto &fragments : join(draw_passes(shape, many, draw)))
            composites.push_back(direction == Direction::front_to_back
                                     ? composite_front_to_back(fragments)
                                     : composite_back_to_front(fragments));
        return composites;
    }

private:
    static Layers read(const DepthPeeling &peeling, const LayerReader &reader, const Shape &shape)
    {
        Layers layers(reader.pixels() * static_cast<std::size_t>(reader.samples()));
        for (int layer = 0; layer < shape.k; ++layer) {
            for (int sample = 0; sample < reader.samples(); ++sample) {
                const auto colors = reader.read_color(peeling.color(), layer, sample);
                const auto depths =
                    reader.read_depth(peeling.depth(), shape.depth_format, layer, sample);
                for (std::size_t pixel = 0; pixel < reader.pixels(); ++pixel) {
                    if (depths[pixel] != shape.empty_depth())
                        layers[reader.pixels() * static_cast<std::size_t>(sample) + pixel]
                            .push_back(
                                {depths[pixel], colors[pixel].r, colors[pixel].g, colors[pixel].b});
                }
            }
        }
        return layers;
    }

    const Gl &gl_;
};

} // namespace

std::unique_ptr<Method> make_peeling(const Gl &gl)
{
    return std::make_unique<PeelingMethod>(gl);
}

} // namespace kb::hard
