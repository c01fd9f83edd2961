// SPDX-License-Identifier: MIT

#include "isosurface/isosurface_renderer.hpp"

#include "isosurface/iso_program.hpp"
#include "lib/gl/mesh_buffers.hpp"

#include <glm/gtc/type_ptr.hpp>

namespace kb
{

/// A fragment behind all others. k of them in each pixel make all that wait leave.
static constexpr const char *flush_shader = R"(#version 330
layout(location = 0) out vec4 fragment;

void main()
{
    fragment = vec4(1e30, 0.0, 0.0, 0.0);
}
)";

Result<IsosurfaceRenderer> IsosurfaceRenderer::make(const Gl &gl,
                                                    const IsosurfaceSettings &settings)
{
    const Size size = settings.shading.size;
    auto kbuffer = KBuffer::make(gl, GL_RGBA32F, size, isosurface_entries(settings.k));
    if (!kbuffer)
        return kbuffer.error();
    auto program = ArbProgram::make(gl, GL_KBUFFER_PROGRAM_MESA,
                                    make_isosurface_program(settings.k, settings.medium));
    if (!program)
        return program.error();
    auto flush = Program::make(gl, full_screen_vertex_shader, flush_shader);
    if (!flush)
        return flush.error();
    auto shading = ShadingPass::make(gl, settings.shading);
    if (!shading)
        return shading.error();
    IsosurfaceRenderer renderer(gl, settings, std::move(*kbuffer), std::move(*program),
                                std::move(*flush), std::move(*shading));
    gl.BindFramebuffer(GL_FRAMEBUFFER, renderer.framebuffer_.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                            renderer.picture_.id(), 0);
    if (auto complete = check_framebuffer(gl); !complete)
        return complete.error();
    if (auto set = renderer.set_iso_values({}); !set)
        return set.error();
    return renderer;
}

IsosurfaceRenderer::IsosurfaceRenderer(const Gl &gl, const IsosurfaceSettings &settings,
                                       KBuffer kbuffer, ArbProgram program, Program flush,
                                       ShadingPass shading)
    : gl_(&gl), settings_(settings), kbuffer_(std::move(kbuffer)), program_(std::move(program)),
      flush_(std::move(flush)), shading_(std::move(shading)),
      table_texture_(make_texture_2d(gl, GL_RGBA32F, 1, 2)), empty_(gl),
      picture_(make_texture_2d(gl, GL_RGBA32F, settings.shading.size.width,
                               settings.shading.size.height)),
      framebuffer_(gl)
{
}

Status IsosurfaceRenderer::set_iso_values(std::span<const IsoValue> values)
{
    GLint max_texels = 0;
    gl_->GetIntegerv(GL_MAX_TEXTURE_SIZE, &max_texels);
    auto table = make_iso_table(values, max_texels);
    if (!table)
        return table.error();
    table_ = std::move(*table);
    std::vector<glm::vec4> rows = table_.neighbours;
    rows.insert(rows.end(), table_.colors.begin(), table_.colors.end());
    gl_->BindTexture(GL_TEXTURE_2D, table_texture_.id());
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        gl_->TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, static_cast<GLsizei>(table_.neighbours.size()), 2,
                    0, GL_RGBA, GL_FLOAT, rows.data());

    const IsosurfaceParameters parameters = isosurface_parameters(table_, settings_.gap);
    program_.bind();
    for (const auto &[index, value] : {std::pair(0U, parameters.table), {1U, parameters.rest}})
        gl_->ProgramLocalParameter4fARB(GL_KBUFFER_PROGRAM_MESA, index, value.x, value.y, value.z,
                                        value.w);
    return check_gl(*gl_, "making the table of iso-values");
}

void IsosurfaceRenderer::capture(const FragmentStream &stream, const OrbitCamera &camera)
{
    kbuffer_.clear(glm::vec4(0.0F));
    gl_->Disable(GL_DEPTH_TEST);
    gl_->BindTexture(GL_TEXTURE_2D, table_texture_.id());
    program_.bind();
    gl_->Enable(GL_KBUFFER_PROGRAM_MESA);
    stream.draw(camera, settings_.shading.size);
    flush();
    gl_->Disable(GL_KBUFFER_PROGRAM_MESA);
}

void IsosurfaceRenderer::flush()
{
    flush_.use();
    for (int i = 0; i < settings_.k; ++i)
        draw_full_screen(*gl_, empty_);
}

void IsosurfaceRenderer::shade(const OrbitCamera &camera)
{
    shading_.draw({kbuffer_, surface_entry(settings_.k), table_texture_, table_.base, table_.scale,
                   table_.offset},
                  camera, framebuffer_.id());
}

ImageRgbaF IsosurfaceRenderer::read_surfaces() const
{
    ImageRgbaF image = kbuffer_.read_entry(surface_entry(settings_.k));
    for (glm::vec4 &pixel : image.pixels)
        pixel = pixel.x > 0.0F ? glm::vec4(1.0F / pixel.x, pixel.y, 0.0F, 1.0F) : glm::vec4(0.0F);
    return image;
}

int IsosurfaceRenderer::bytes_per_pixel() const
{
    // The k-buffer, depth and iso-value twice, the picture.
    return 16 * kbuffer_.attachments() * kbuffer_.layers() + 2 * 8 + 16;
}

} // namespace kb
