// SPDX-License-Identifier: MIT
//
// Classic depth peeling (Everitt 2001), to compare with: pass i draws the whole scene with the
// depth test on and discards what is not behind the depths of pass i - 1. Of fragments with equal
// depth it keeps one.

#include "lib/gl/kbuffer.hpp"
#include "transparency/resolve.hpp"

#include <fmt/format.h>

namespace kb
{

namespace
{

constexpr const char *peel_declarations = "uniform sampler2D nearer;\n";
constexpr const char *peel_discard = R"(
    if (gl_FragCoord.z <= texelFetch(nearer, ivec2(gl_FragCoord.xy), 0).x)
        discard;
)";

class ClassicPeelingMethod final : public Method
{
public:
    ClassicPeelingMethod(const Gl &gl, const MethodOptions &options, Program first, Program next,
                         ResolvePass resolve)
        : gl_(gl), options_(options), first_(std::move(first)), next_(std::move(next)),
          resolve_(std::move(resolve)), colors_(gl)
    {
    }

    Status make_layers();
    void capture(const Scene &scene, const OrbitCamera &camera) override;

    void resolve(GLuint framebuffer) override
    {
        gl_.BindTexture(GL_TEXTURE_2D_ARRAY, colors_.id());
        resolve_.draw(framebuffer);
    }

    std::vector<Layer> read_layers() const override;

    int geometry_passes() const override { return options_.k; }
    int bytes_per_pixel() const override
    {
        return options_.k * (color_format() == GL_RGBA8 ? 4 + 4 : 16 + 4);
    }

private:
    /// Colors as exact as those of the k-buffer's layout.
    GLenum color_format() const
    {
        return options_.layout == EntryLayout::packed ? GL_RGBA8 : GL_RGBA32F;
    }

    const Gl &gl_;
    MethodOptions options_;
    Program first_;
    Program next_;
    ResolvePass resolve_;
    Texture colors_; ///< An array of k layers.
    std::vector<Texture> depths_;
    std::vector<Framebuffer> framebuffers_;
};

Status ClassicPeelingMethod::make_layers()
{
    colors_ = make_texture_2d_array(gl_, color_format(), options_.size.width, options_.size.height,
                                    options_.k);
    for (int i = 0; i < options_.k; ++i) {
        depths_.push_back(
            make_texture_2d(gl_, GL_DEPTH_COMPONENT32F, options_.size.width, options_.size.height));
        framebuffers_.emplace_back(gl_);
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffers_.back().id());
        gl_.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, colors_.id(), 0, i);
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D,
                                 depths_.back().id(), 0);
        if (auto complete = check_framebuffer(gl_); !complete)
            return complete;
    }
    return ok;
}

void ClassicPeelingMethod::capture(const Scene &scene, const OrbitCamera &camera)
{
    gl_.Viewport(0, 0, options_.size.width, options_.size.height);
    gl_.Disable(GL_BLEND);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    gl_.ClearDepth(1.0);
    for (std::size_t i = 0; i < framebuffers_.size(); ++i) {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffers_[i].id());
        gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        if (i > 0)
            gl_.BindTexture(GL_TEXTURE_2D, depths_[i - 1].id());
        scene.draw(i == 0 ? first_ : next_, camera, options_.size);
    }
    gl_.Disable(GL_DEPTH_TEST);
}

std::vector<Layer> ClassicPeelingMethod::read_layers() const
{
    std::vector<Layer> layers;
    for (const Framebuffer &framebuffer : framebuffers_) {
        Layer layer{read_color(gl_, framebuffer.id(), options_.size),
                    read_depth(gl_, framebuffer.id(), options_.size)};
        layers.push_back(std::move(layer));
    }
    return layers;
}

/// Where nothing was drawn the color is cleared: its alpha of 0 adds nothing. RGBZ keeps no alpha,
/// so neither counts it here.
std::string fetch_code(const MethodOptions &options)
{
    return fmt::format("    for (int layer = 0; layer < {}; ++layer)\n"
                       "        add(texelFetch(attachment0, ivec3(pixel, layer), 0));\n",
                       options.k);
}

} // namespace

Result<std::unique_ptr<Method>> make_classic_peeling_method(const Gl &gl,
                                                            const MethodOptions &options)
{
    auto first = Scene::make_program(gl);
    if (!first)
        return first.error();
    auto next = Scene::make_program(gl, peel_declarations, peel_discard);
    if (!next)
        return next.error();
    auto resolve = ResolvePass::make(gl, options, "uniform sampler2DArray attachment0;\n",
                                     fetch_code(options));
    if (!resolve)
        return resolve.error();
    auto method = std::make_unique<ClassicPeelingMethod>(gl, options, std::move(*first),
                                                         std::move(*next), std::move(*resolve));
    if (auto made = method->make_layers(); !made)
        return made.error();
    return std::unique_ptr<Method>(std::move(method));
}

} // namespace kb
