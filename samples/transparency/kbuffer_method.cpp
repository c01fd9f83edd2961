// SPDX-License-Identifier: MIT
//
// Clear the k-buffer, enable the program, draw once: entry by entry the k nearest fragments of
// every pixel are there, sorted.

#include "lib/gl/kbuffer.hpp"
#include "transparency/resolve.hpp"

#include <fmt/format.h>

#include <bit>

namespace kb
{

namespace
{

/// The cleared entry: no color, depth 1.
glm::vec4 empty_entry(EntryLayout layout)
{
    return layout == EntryLayout::rgbz ? glm::vec4(0.0F, 0.0F, 0.0F, 1.0F)
                                       : glm::vec4(0.0F, 1.0F, 0.0F, 1.0F);
}

constexpr const char *unpack_declarations = R"(
vec4 unpack(float value)
{
    uint bits = floatBitsToUint(value);
    return vec4(uvec4(bits, bits >> 8u, bits >> 16u, bits >> 24u) & 255u) / 255.0;
}
)";

/// Adds the fragments of each entry; nothing is behind the first that is empty.
std::string fetch_code(const KBuffer &kbuffer, EntryLayout layout)
{
    std::string code = fmt::format("    for (int layer = 0; layer < {}; ++layer) {{\n"
                                   "        vec4 entry;\n",
                                   kbuffer.layers());
    for (int a = 0; a < kbuffer.attachments(); ++a) {
        code +=
            fmt::format("        entry = texelFetch(attachment{}, ivec3(pixel, layer), 0);\n", a);
        code += layout == EntryLayout::rgbz ? "        if (!(entry.w < 1.0)) break;\n"
                                              "        add(vec4(entry.rgb, alpha));\n"
                                            : "        if (!(entry.y < 1.0)) break;\n"
                                              "        add(unpack(entry.x));\n"
                                              "        if (!(entry.w < 1.0)) break;\n"
                                              "        add(unpack(entry.z));\n";
    }
    return code + "    }\n";
}

std::string sampler_declarations(int attachments)
{
    std::string code;
    for (int a = 0; a < attachments; ++a)
        code += fmt::format("uniform sampler2DArray attachment{};\n", a);
    return code;
}

glm::vec4 unpack(float value)
{
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return glm::vec4(bits & 255U, bits >> 8U & 255U, bits >> 16U & 255U, bits >> 24U) / 255.0F;
}

class KBufferMethod final : public Method
{
public:
    KBufferMethod(const Gl &gl, const MethodOptions &options, KBuffer kbuffer, Program shading,
                  ArbProgram insertion, ResolvePass resolve)
        : gl_(gl), options_(options), kbuffer_(std::move(kbuffer)), shading_(std::move(shading)),
          insertion_(std::move(insertion)), resolve_(std::move(resolve))
    {
    }

    void capture(const Scene &scene, const OrbitCamera &camera) override
    {
        kbuffer_.clear(empty_entry(options_.layout));
        gl_.Disable(GL_DEPTH_TEST);
        insertion_.bind();
        gl_.Enable(GL_KBUFFER_PROGRAM_MESA);
        scene.draw(shading_, camera, options_.size);
        gl_.Disable(GL_KBUFFER_PROGRAM_MESA);
    }

    void resolve(GLuint framebuffer) override
    {
        kbuffer_.bind_textures();
        resolve_.draw(framebuffer);
    }

    std::vector<Layer> read_layers() const override;

    int bytes_per_pixel() const override { return 16 * kbuffer_.attachments() * kbuffer_.layers(); }

private:
    const Gl &gl_;
    MethodOptions options_;
    KBuffer kbuffer_;
    Program shading_;
    ArbProgram insertion_;
    ResolvePass resolve_;
};

std::vector<Layer> KBufferMethod::read_layers() const
{
    const int per_entry = fragments_per_entry(options_.layout);
    std::vector<Layer> layers;
    for (int i = 0; i < options_.k; ++i) {
        const ImageRgbaF entry = kbuffer_.read_entry(i / per_entry);
        Layer layer{ImageRgbaF(entry.width, entry.height), ImageF(entry.width, entry.height)};
        for (std::size_t p = 0; p < entry.pixels.size(); ++p) {
            const glm::vec4 &value = entry.pixels[p];
            if (options_.layout == EntryLayout::rgbz) {
                layer.depth.pixels[p] = value.w;
                layer.color.pixels[p] =
                    value.w < 1.0F ? glm::vec4(glm::vec3(value), options_.alpha) : glm::vec4(0.0F);
            } else {
                const int place = 2 * (i % per_entry);
                layer.depth.pixels[p] = value[place + 1];
                layer.color.pixels[p] = unpack(value[place]);
            }
        }
        layers.push_back(std::move(layer));
    }
    return layers;
}

} // namespace

Result<std::unique_ptr<Method>> make_kbuffer_method(const Gl &gl, const MethodOptions &options)
{
    auto text = make_insertion_program(options.layout, options.k);
    if (!text)
        return text.error();
    auto kbuffer =
        KBuffer::make(gl, GL_RGBA32F, options.size, entry_count(options.layout, options.k));
    if (!kbuffer)
        return kbuffer.error();
    auto insertion = ArbProgram::make(gl, GL_KBUFFER_PROGRAM_MESA, *text);
    if (!insertion)
        return insertion.error();
    auto shading = Scene::make_program(gl);
    if (!shading)
        return shading.error();
    auto resolve = ResolvePass::make(
        gl, options, sampler_declarations(kbuffer->attachments()) + unpack_declarations,
        fetch_code(*kbuffer, options.layout));
    if (!resolve)
        return resolve.error();
    return std::unique_ptr<Method>(
        std::make_unique<KBufferMethod>(gl, options, std::move(*kbuffer), std::move(*shading),
                                        std::move(*insertion), std::move(*resolve)));
}

} // namespace kb
