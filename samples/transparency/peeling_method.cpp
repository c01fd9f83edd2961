// SPDX-License-Identifier: MIT
//
// Clear the layers, enable GL_DEPTH_PEELING, draw once: layer by layer the k nearest fragments of
// every pixel are there, sorted.

#include "lib/gl/depth_peeling.hpp"
#include "transparency/resolve.hpp"

#include <fmt/format.h>

namespace kb
{

namespace
{

class PeelingMethod final : public Method
{
public:
    PeelingMethod(const Gl &gl, const MethodOptions &options, DepthPeeling peeling, Program shading,
                  ResolvePass resolve)
        : gl_(gl), options_(options), peeling_(std::move(peeling)), shading_(std::move(shading)),
          resolve_(std::move(resolve))
    {
    }

    void capture(const Scene &scene, const OrbitCamera &camera) override
    {
        peeling_.clear();
        gl_.Enable(GL_DEPTH_PEELING_MESA);
        scene.draw(shading_, camera, options_.size);
        gl_.Disable(GL_DEPTH_PEELING_MESA);
    }

    void resolve(GLuint framebuffer) override
    {
        peeling_.bind_textures();
        resolve_.draw(framebuffer);
    }

    std::vector<Layer> read_layers() const override
    {
        std::vector<Layer> layers;
        for (int i = 0; i < options_.k; ++i)
            layers.push_back({peeling_.read_color(i), peeling_.read_depth(i)});
        return layers;
    }

    int bytes_per_pixel() const override { return peeling_.bytes_per_pixel(); }

private:
    const Gl &gl_;
    MethodOptions options_;
    DepthPeeling peeling_;
    Program shading_;
    ResolvePass resolve_;
};

/// Adds the fragments of each layer; nothing is behind the first that is empty.
std::string fetch_code(int layers)
{
    return fmt::format("    for (int layer = 0; layer < {}; ++layer) {{\n"
                       "        if (!(texelFetch(attachment1, ivec3(pixel, layer), 0).x < 1.0)) "
                       "break;\n"
                       "        add(texelFetch(attachment0, ivec3(pixel, layer), 0));\n"
                       "    }}\n",
                       layers);
}

} // namespace

Result<std::unique_ptr<Method>> make_peeling_method(const Gl &gl, const MethodOptions &options)
{
    PeelingLayers layers;
    layers.size = options.size;
    layers.count = options.k;
    // Colors as exact as those of the k-buffer's layout.
    layers.color_formats = {options.layout == EntryLayout::packed ? GLenum(GL_RGBA8)
                                                                  : GLenum(GL_RGBA32F)};
    auto peeling = DepthPeeling::make(gl, layers);
    if (!peeling)
        return peeling.error();
    auto shading = Scene::make_program(gl);
    if (!shading)
        return shading.error();
    auto resolve = ResolvePass::make(gl, options,
                                     "uniform sampler2DArray attachment0; // color\n"
                                     "uniform sampler2DArray attachment1; // depth\n",
                                     fetch_code(options.k));
    if (!resolve)
        return resolve.error();
    return std::unique_ptr<Method>(std::make_unique<PeelingMethod>(
        gl, options, std::move(*peeling), std::move(*shading), std::move(*resolve)));
}

} // namespace kb
