// SPDX-License-Identifier: MIT
//
// GL_MESA_depth_peeling: one pass over the geometry, in which the driver inserts each fragment by
// its depth into k layers.

#include "lib/gl/depth_peeling.hpp"

#include "bench/layer_resolve.hpp"
#include "bench/renderer.hpp"

namespace kb::bench
{

namespace
{

class DepthPeelingRenderer final : public Renderer
{
public:
    DepthPeelingRenderer(const Gl &gl, Size size, int k)
        : gl_(gl), peeling_(must(DepthPeeling::make(gl, {.size = size, .count = k}))),
          shading_(make_geometry_program(gl, "", R"(
out vec4 color;

void main()
{
    color = shade();
}
)")),
          resolve_(gl, k)
    {
    }

    void draw(const GlScene &scene, GLuint target) override
    {
        peeling_.clear();
        gl_.Enable(GL_DEPTH_PEELING_MESA);
        scene.draw(shading_);
        gl_.Disable(GL_DEPTH_PEELING_MESA);
        resolve_.draw(peeling_.color(), target);
    }

    int bytes_per_pixel() const override { return peeling_.bytes_per_pixel(); }

private:
    const Gl &gl_;
    DepthPeeling peeling_;
    Program shading_;
    LayerResolve resolve_;
};

} // namespace

std::unique_ptr<Renderer> make_depth_peeling(const Gl &gl, Size size, int k)
{
    return std::make_unique<DepthPeelingRenderer>(gl, size, k);
}

} // namespace kb::bench
