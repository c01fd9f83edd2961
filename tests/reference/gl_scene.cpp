// SPDX-License-Identifier: MIT

#include "tests/reference/gl_scene.hpp"

#include "lib/gl/context.hpp"
#include "lib/gl/mesh_buffers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace kb::reference
{

namespace
{

constexpr int floats_a_vertex = 9;

constexpr GLenum gl_func(Func func)
{
    switch (func) {
    case Func::lequal:
        return GL_LEQUAL;
    case Func::greater:
        return GL_GREATER;
    case Func::gequal:
        return GL_GEQUAL;
    case Func::less:
        break;
    }
    return GL_LESS;
}

std::string vertex_shader(bool flat)
{
    return fmt::format(R"(#version 330
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 vertex_color;
layout(location = 2) in float vertex_id;
{0} out vec4 color;
flat out float id;

void main()
{{
    gl_Position = position;
    color = vertex_color;
    id = vertex_id;
}}
)",
                       flat ? "flat" : "smooth");
}

std::string fragment_shader(bool flat, const std::vector<ColorFormat> &outputs)
{
    static constexpr std::array<const char *, 4> swizzles{"rgba", "gbar", "barg", "argb"};
    std::string declarations;
    std::string assignments;
    for (std::size_t a = 0; a < outputs.size(); ++a) {
        const bool integer = outputs[a] == ColorFormat::r32ui;
        declarations += fmt::format("layout(location = {0}) out {1} result{0};\n", a,
                                    integer ? "uint" : "vec4");
        assignments += integer ? fmt::format("    result{} = uint(id);\n", a)
                               : fmt::format("    result{} = color.{};\n", a, swizzles[a]);
    }
    return fmt::format("#version 330\n{} in vec4 color;\nflat in float id;\n{}\nvoid main()\n{{\n{}"
                       "}}\n",
                       flat ? "flat" : "smooth", declarations, assignments);
}

std::string counting_fragment_shader(bool flat)
{
    return fmt::format(R"(#version 330
{} in vec4 color;
layout(location = 0) out vec4 result;
layout(location = 1) out vec4 count;

void main()
{{
    result = color;
    count = vec4(1.0);
}}
)",
                       flat ? "flat" : "smooth");
}

/// Front to back over black, for each sample; alpha is the transmittance.
std::string compose_shader(const Scene &scene, int attachments)
{
    const char *sampler = scene.samples > 0 ? "sampler2DMSArray" : "sampler2DArray";
    std::string text = "#version 330\n";
    std::string cases;
    for (int a = 0; a < attachments; ++a) {
        text += fmt::format("uniform {} entries{};\n", sampler, a);
        cases += fmt::format(
            "    if (e % {} == {})\n        return texelFetch(entries{}, ivec3(p, e / {}), s);\n",
            attachments, a, a, attachments);
    }
    text += fmt::format(R"(uniform int layers;
uniform int samples;
layout(location = 0) out vec4 result;

vec4 entry(int e, ivec2 p, int s)
{{
{}    return vec4(0.0);
}}

vec4 fragment(int i, ivec2 p, int s)
{{
)",
                        cases);
    if (scene.extension == Extension::peeling)
        text += "    return entry(i, p, s);\n";
    else if (scene.layout == EntryLayout::rgbz)
        text += fmt::format("    vec4 e = entry(i, p, s);\n"
                            "    return vec4(e.rgb, e.a < 1.0 ? {} : 0.0);\n",
                            constant_alpha);
    else
        text += R"(    vec4 e = entry(i / 2, p, s);
    vec2 half_entry = i % 2 == 0 ? e.xy : e.zw;
    uint bits = floatBitsToUint(half_entry.x);
    return half_entry.y < 1.0 ? vec4(bits & 255u, bits >> 8 & 255u, bits >> 16 & 255u,
                                     bits >> 24) / 255.0 : vec4(0.0);
)";
    return text + R"(}

void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 sum = vec4(0.0);
    for (int s = 0; s < samples; ++s) {
        vec3 color = vec3(0.0);
        float transmittance = 1.0;
        for (int i = 0; i < layers; ++i) {
            vec4 f = fragment(i, p, s);
            color += transmittance * f.a * f.rgb;
            transmittance *= 1.0 - f.a;
        }
        sum += vec4(color, transmittance);
    }
    result = sum / float(samples);
}
)";
}

} // namespace

std::vector<ColorFormat> kept_colors(const Scene &scene)
{
    if (scene.extension == Extension::peeling)
        return scene.color_formats;
    switch (scene.layout) {
    case EntryLayout::rgbz:
        return {ColorFormat::rgba32f};
    case EntryLayout::packed:
        return {ColorFormat::rgba8};
    case EntryLayout::depth:
    case EntryLayout::depth4:
        break;
    }
    return {};
}

DepthFormat kept_depth(const Scene &scene)
{
    return scene.extension == Extension::peeling ? scene.depth_format : DepthFormat::d32f;
}

std::optional<std::size_t> composed_attachment(const Scene &scene)
{
    // The first: the others have another channel as alpha.
    const auto formats = kept_colors(scene);
    if (formats.empty() || formats[0] == ColorFormat::r32ui || formats[0] == ColorFormat::r8 ||
        formats[0] == ColorFormat::rgb10_a2)
        return std::nullopt;
    return 0;
}

SceneDrawer::SceneDrawer(const Gl &gl)
    : gl_(&gl), reader_(gl), array_(gl), empty_(gl), vertices_(gl)
{
    gl.BindVertexArray(array_.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
    constexpr std::array<GLint, 3> sizes{4, 4, 1};
    std::size_t offset = 0;
    for (GLuint i = 0; i < sizes.size(); ++i) {
        gl.EnableVertexAttribArray(i);
        gl.VertexAttribPointer(i, sizes[i], GL_FLOAT, GL_FALSE, floats_a_vertex * sizeof(float),
                               reinterpret_cast<const void *>(offset * sizeof(float)));
        offset += static_cast<std::size_t>(sizes[i]);
    }
}

Status SceneDrawer::check_support(const Scene &scene) const
{
    auto supported = scene.extension == Extension::peeling ? require_depth_peeling(gl())
                                                           : require_kbuffer_program(gl());
    if (!supported)
        return supported;
    GLint samples = 0;
    gl().GetIntegerv(GL_MAX_COLOR_TEXTURE_SAMPLES, &samples);
    if (scene.samples > samples)
        return Error{fmt::format("the scene has {} samples, this driver's textures have {} ({})",
                                 scene.samples, samples, describe_driver(gl()))};
    return ok;
}

Result<RasterRules> SceneDrawer::rules(const Scene &scene) const
{
    RasterRules rules;
    rules.snaps = describe_driver(gl()).find("llvmpipe") != std::string::npos;
    rules.steps_of_16_bits = rules.snaps ? 1 : 16;
    if (scene.samples == 0)
        return rules;
    // Asked of a framebuffer that has them.
    auto target = Target::make(gl(), {1, 1, 1, scene.samples, {GL_RGBA8}, std::nullopt});
    if (!target)
        return target.error();
    rules.samples.clear();
    for (int i = 0; i < scene.samples; ++i) {
        std::array<float, 2> position{};
        gl().GetMultisamplefv(GL_SAMPLE_POSITION, static_cast<GLuint>(i), position.data());
        for (const float p : position) {
            if (256.0F * p != std::floor(256.0F * p))
                return Error{"a sample is not at a multiple of 1/256 pixel"};
        }
        rules.samples.push_back(
            {static_cast<int>(256.0F * position[0]), static_cast<int>(256.0F * position[1])});
    }
    return rules;
}

Status SceneDrawer::upload(const Scene &scene)
{
    std::vector<float> data;
    steps_.clear();
    int first = 0;
    for (const Step &step : scene.steps) {
        const int count = 3 * static_cast<int>(step.triangles.size());
        steps_.push_back({&step, first, count});
        first += count;
        for (const Triangle &triangle : step.triangles) {
            for (const Vertex &vertex : triangle.vertices) {
                data.insert(data.end(), vertex.position.begin(), vertex.position.end());
                data.insert(data.end(), vertex.color.begin(), vertex.color.end());
                data.push_back(static_cast<float>(triangle.id));
            }
        }
    }
    gl().BindVertexArray(array_.id());
    gl().BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
    gl().BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(float)),
                    data.data(), GL_STATIC_DRAW);
    return check_gl(gl(), "making the vertices");
}

void SceneDrawer::set_state(const Scene &scene) const
{
    const Box &v = scene.viewport;
    gl().Viewport(v.x, v.y, v.width, v.height);
    gl().DepthRange(scene.depth_range[0], scene.depth_range[1]);
    gl().ClipControl(GL_LOWER_LEFT, scene.zero_to_one ? GL_ZERO_TO_ONE : GL_NEGATIVE_ONE_TO_ONE);
}

void SceneDrawer::begin_step(const Step &step) const
{
    if (step.scissor) {
        gl().Enable(GL_SCISSOR_TEST);
        gl().Scissor(step.scissor->x, step.scissor->y, step.scissor->width, step.scissor->height);
    } else {
        gl().Disable(GL_SCISSOR_TEST);
    }
    if (step.cull == Cull::none) {
        gl().Disable(GL_CULL_FACE);
    } else {
        gl().Enable(GL_CULL_FACE);
        gl().CullFace(step.cull == Cull::front ? GL_FRONT : GL_BACK);
    }
}

Result<const Program *> SceneDrawer::program_of(const std::string &vertex,
                                                const std::string &fragment)
{
    auto found = programs_.find(fragment);
    if (found == programs_.end()) {
        auto program = Program::make(gl(), vertex, fragment);
        if (!program)
            return program.error();
        found = programs_.emplace(fragment, std::move(*program)).first;
    }
    return &found->second;
}

Result<std::vector<TriangleDump>> SceneDrawer::dump(const Scene &scene)
{
    std::vector<TriangleDump> dumps(scene.triangle_count());
    if (dumps.empty())
        return dumps;
    if (auto uploaded = upload(scene); !uploaded)
        return uploaded.error();
    auto program = program_of(vertex_shader(scene.flat), counting_fragment_shader(scene.flat));
    if (!program)
        return program.error();
    auto target = Target::make(gl(), {scene.width,
                                      scene.height,
                                      static_cast<int>(dumps.size()),
                                      scene.samples,
                                      {GL_RGBA32F, GL_R32F},
                                      kept_depth(scene)});
    if (!target)
        return target.error();

    gl().Disable(GL_SCISSOR_TEST);
    gl().ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    gl().ClearDepth(1.0);
    gl().Enable(GL_BLEND);
    gl().BlendFunci(0, GL_ONE, GL_ZERO);
    gl().BlendFunci(1, GL_ONE, GL_ONE); // Counts.
    gl().Enable(GL_DEPTH_TEST);
    gl().DepthFunc(GL_ALWAYS);
    gl().Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    set_state(scene);
    (*program)->use();
    gl().BindVertexArray(array_.id());
    int layer = 0;
    for (const StepRange &range : steps_) {
        begin_step(*range.step);
        for (int i = 0; i < range.count; i += 3) {
            target->bind_layer(layer++);
            gl().DrawArrays(GL_TRIANGLES, range.first + i, 3);
        }
    }
    gl().Disable(GL_SCISSOR_TEST);
    gl().Disable(GL_CULL_FACE);
    gl().Disable(GL_DEPTH_TEST);
    gl().Disable(GL_BLEND);
    gl().DepthRange(0.0, 1.0);
    auto colors = target->read_color(0, reader_);
    auto counts = target->read_color(1, reader_);
    auto depths = target->read_depth(reader_);
    if (auto drawn = check_gl(gl(), "drawing the triangles alone"); !drawn)
        return drawn.error();
    if (!colors)
        return colors.error();
    if (!counts)
        return counts.error();
    if (!depths)
        return depths.error();
    const auto size = static_cast<std::ptrdiff_t>(target->shape().samples_a_layer());
    for (std::size_t t = 0; t < dumps.size(); ++t) {
        const auto at = static_cast<std::ptrdiff_t>(t) * size;
        dumps[t].color.assign(colors->begin() + at, colors->begin() + at + size);
        dumps[t].depth.assign(depths->begin() + at, depths->begin() + at + size);
        for (auto count = counts->begin() + at; count != counts->begin() + at + size; ++count)
            dumps[t].count.push_back(static_cast<std::uint8_t>((*count)[0]));
    }
    return dumps;
}

void SceneDrawer::clear(const Scene &scene, std::size_t attachments) const
{
    gl().DepthMask(GL_TRUE);
    gl().ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    if (scene.extension == Extension::peeling) {
        constexpr std::array<GLuint, 4> zero_integers{};
        constexpr std::array<float, 4> zeros{};
        for (std::size_t a = 0; a < attachments; ++a) {
            const auto buffer = static_cast<GLint>(a);
            if (scene.color_formats[a] == ColorFormat::r32ui)
                gl().ClearBufferuiv(GL_COLOR, buffer, zero_integers.data());
            else
                gl().ClearBufferfv(GL_COLOR, buffer, zeros.data());
        }
        gl().Clear(GL_DEPTH_BUFFER_BIT);
    } else {
        std::array<float, 4> value{1.0F, 1.0F, 1.0F, 1.0F};
        if (scene.layout == EntryLayout::rgbz)
            value = {0.0F, 0.0F, 0.0F, 1.0F};
        else if (scene.layout == EntryLayout::packed)
            value = {0.0F, 1.0F, 0.0F, 1.0F};
        for (std::size_t a = 0; a < attachments; ++a)
            gl().ClearBufferfv(GL_COLOR, static_cast<GLint>(a), value.data());
    }
    const auto &mask = scene.color_mask;
    gl().ColorMask(mask[0], mask[1], mask[2], mask[3]);
}

void SceneDrawer::draw_steps(const Scene &scene, std::size_t attachments) const
{
    gl().Disable(GL_SCISSOR_TEST);
    clear(scene, attachments);
    gl().BindVertexArray(array_.id());
    for (const StepRange &range : steps_) {
        begin_step(*range.step);
        if (range.step->clear) {
            clear(scene, attachments);
        } else {
            gl().DepthMask(range.step->depth_mask);
            gl().DrawArrays(GL_TRIANGLES, range.first, range.count);
        }
    }
    gl().Disable(GL_SCISSOR_TEST);
    gl().Disable(GL_CULL_FACE);
    gl().DepthMask(GL_TRUE);
    gl().ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

Result<std::vector<Color>> SceneDrawer::compose(const Scene &scene, const Target &target)
{
    if (!composed_attachment(scene))
        return std::vector<Color>();
    const int attachments =
        scene.extension == Extension::peeling ? 1 : static_cast<int>(target.shape().colors.size());
    auto program = program_of(full_screen_vertex_shader, compose_shader(scene, attachments));
    if (!program)
        return program.error();
    const Texture picture = make_texture_2d(gl(), GL_RGBA32F, scene.width, scene.height);
    const Framebuffer framebuffer(gl());
    gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl().FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture.id(), 0);
    if (auto complete = check_framebuffer(gl()); !complete)
        return complete.error();
    gl().Viewport(0, 0, scene.width, scene.height);
    gl().DepthRange(0.0, 1.0);
    target.bind_textures();
    (*program)->use();
    for (int a = 0; a < attachments; ++a)
        gl().Uniform1i((*program)->uniform(fmt::format("entries{}", a).c_str()), a);
    gl().Uniform1i((*program)->uniform("layers"), scene.k);
    gl().Uniform1i((*program)->uniform("samples"), scene.sample_count());
    draw_full_screen(gl(), empty_);
    std::vector<Color> pixels(std::size_t(scene.width) * std::size_t(scene.height));
    gl().ReadPixels(0, 0, scene.width, scene.height, GL_RGBA, GL_FLOAT, pixels.data());
    return pixels;
}

Result<std::vector<Pass>> SceneDrawer::peel(const Scene &scene)
{
    std::vector<GLenum> formats;
    for (const ColorFormat format : scene.color_formats)
        formats.push_back(internal_format(format));
    auto target = Target::make(
        gl(), {scene.width, scene.height, scene.k, scene.samples, formats, scene.depth_format});
    if (!target)
        return target.error();
    auto program =
        program_of(vertex_shader(scene.flat), fragment_shader(scene.flat, scene.color_formats));
    if (!program)
        return program.error();

    std::vector<Pass> passes;
    // Each triangle is at most one fragment of a sample, and a pass that finds none is the last.
    const std::size_t most = scene.triangle_count() / std::size_t(scene.k) + 2;
    do {
        target->bind_all();
        if (!passes.empty())
            gl().FramebufferParameteri(GL_DRAW_FRAMEBUFFER, GL_DEPTH_PEELING_FIRST_LAYER_MESA,
                                       static_cast<GLint>(passes.size()) * scene.k);
        set_state(scene);
        gl().DepthFunc(gl_func(scene.func));
        gl().ClearDepth(static_cast<double>(scene.clear_depth));
        (*program)->use();
        gl().Enable(GL_DEPTH_PEELING_MESA);
        draw_steps(scene, formats.size());
        gl().Disable(GL_DEPTH_PEELING_MESA);

        Pass &pass = passes.emplace_back();
        GLint overflow = 0;
        gl().GetFramebufferParameteriv(GL_DRAW_FRAMEBUFFER, GL_DEPTH_PEELING_OVERFLOW_MESA,
                                       &overflow);
        pass.overflow = overflow != 0;
        auto composite = compose(scene, *target);
        if (!composite)
            return composite.error();
        pass.composite = std::move(*composite);
        for (std::size_t a = 0; a < formats.size(); ++a) {
            auto colors = target->read_color(a, reader_);
            if (!colors)
                return colors.error();
            pass.colors.push_back(std::move(*colors));
        }
        auto depth = target->read_depth(reader_);
        if (!depth)
            return depth.error();
        pass.depth = std::move(*depth);
        if (auto drawn = check_gl(gl(), "peeling"); !drawn)
            return drawn.error();
    } while (scene.all_passes && passes.back().overflow && passes.size() <= most);
    return passes;
}

Result<const ArbProgram *> SceneDrawer::kbuffer_program(const Scene &scene)
{
    auto text = make_insertion_program(scene.layout, scene.k);
    if (!text)
        return text.error();
    auto found = kbuffer_programs_.find(*text);
    if (found == kbuffer_programs_.end()) {
        auto program = ArbProgram::make(gl(), GL_KBUFFER_PROGRAM_MESA, *text);
        if (!program)
            return program.error();
        found = kbuffer_programs_.emplace(*text, std::move(*program)).first;
    }
    return &found->second;
}

/// The fragments in the entries of a k-buffer as layers.
static Pass unpack(const Scene &scene, const std::vector<std::vector<Color>> &attachments)
{
    const std::size_t samples =
        std::size_t(scene.width) * std::size_t(scene.height) * std::size_t(scene.sample_count());
    const auto per_entry = static_cast<std::size_t>(fragments_per_entry(scene.layout));
    const auto k = static_cast<std::size_t>(scene.k);
    Pass pass;
    pass.depth.resize(k * samples);
    pass.colors.resize(kept_colors(scene).size());
    for (auto &colors : pass.colors)
        colors.resize(k * samples);
    for (std::size_t i = 0; i < k * samples; ++i) {
        const std::size_t e = i / samples / per_entry;
        const std::size_t place = i / samples % per_entry;
        const Color &entry =
            attachments[e % attachments.size()][e / attachments.size() * samples + i % samples];
        float depth = 0.0F;
        switch (scene.layout) {
        case EntryLayout::rgbz:
            depth = entry[3];
            pass.colors[0][i] = {entry[0], entry[1], entry[2], constant_alpha};
            break;
        case EntryLayout::packed: {
            depth = entry[2 * place + 1];
            const auto bits = std::bit_cast<std::uint32_t>(entry[2 * place]);
            for (std::size_t c = 0; c < 4; ++c)
                pass.colors[0][i][c] = static_cast<float>(bits >> (8 * c) & 255U) / 255.0F;
            break;
        }
        case EntryLayout::depth:
        case EntryLayout::depth4:
            depth = entry[place];
            break;
        }
        pass.depth[i] = encode_depth(DepthFormat::d32f, static_cast<double>(depth));
    }
    return pass;
}

Result<std::vector<Pass>> SceneDrawer::run_program(const Scene &scene)
{
    constexpr int most_attachments = 8;
    const int entries = entry_count(scene.layout, scene.k);
    const int layers = (entries + most_attachments - 1) / most_attachments;
    const int count = (entries + layers - 1) / layers;
    const std::vector<GLenum> formats(std::size_t(count),
                                      scene.layout == EntryLayout::depth ? GL_R32F : GL_RGBA32F);
    auto target = Target::make(
        gl(), {scene.width, scene.height, layers, scene.samples, formats, std::nullopt});
    if (!target)
        return target.error();
    auto program =
        program_of(vertex_shader(scene.flat), fragment_shader(scene.flat, {ColorFormat::rgba32f}));
    if (!program)
        return program.error();
    auto insertion = kbuffer_program(scene);
    if (!insertion)
        return insertion.error();

    target->bind_all();
    set_state(scene);
    (*program)->use();
    (*insertion)->bind();
    gl().Enable(GL_KBUFFER_PROGRAM_MESA);
    draw_steps(scene, formats.size());
    gl().Disable(GL_KBUFFER_PROGRAM_MESA);

    auto composite = compose(scene, *target);
    if (!composite)
        return composite.error();
    std::vector<std::vector<Color>> attachments;
    for (std::size_t a = 0; a < formats.size(); ++a) {
        auto colors = target->read_color(a, reader_);
        if (!colors)
            return colors.error();
        attachments.push_back(std::move(*colors));
    }
    if (auto drawn = check_gl(gl(), "drawing with a k-buffer program"); !drawn)
        return drawn.error();
    std::vector<Pass> passes{unpack(scene, attachments)};
    passes[0].composite = std::move(*composite);
    return passes;
}

Result<std::vector<Pass>> SceneDrawer::draw(const Scene &scene)
{
    if (auto uploaded = upload(scene); !uploaded)
        return uploaded.error();
    return scene.extension == Extension::peeling ? peel(scene) : run_program(scene);
}

} // namespace kb::reference
