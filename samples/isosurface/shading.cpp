// SPDX-License-Identifier: MIT

#include "isosurface/shading.hpp"

#include "lib/gl/mesh_buffers.hpp"

namespace kb
{

/// 1 / distance along the ray to 1 / depth.
static constexpr const char *gather_shader = R"(#version 330
uniform sampler2DArray entries;
uniform int layer;
uniform vec4 view; // Width, height, slopes of the rays at the right and the upper edge.
layout(location = 0) out vec2 surface;

void main()
{
    vec2 xy = (2.0 * gl_FragCoord.xy / view.xy - 1.0) * view.zw;
    vec2 entry = texelFetch(entries, ivec3(gl_FragCoord.xy, layer), 0).xy;
    surface = vec2(entry.x * sqrt(1.0 + dot(xy, xy)), entry.y);
}
)";

/// A pixel's neighbours count in pairs, opposite to each other, so that planes stay what they are
/// however steep; the less, the more there is of a step in depth to one of them.
static constexpr const char *smooth_shader = R"(#version 330
uniform sampler2D surfaces;
uniform int axis;
uniform int radius;
uniform float depth_step;
layout(location = 0) out vec2 surface;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(surfaces, 0) - 1;
    surface = texelFetch(surfaces, pixel, 0).xy;
    if (surface.x == 0.0)
        return;
    float sum = surface.x;
    float weights = 1.0;
    float most = 2.0 * depth_step * surface.x * surface.x;
    for (int i = 1; i <= radius; ++i) {
        ivec2 offset = i * ivec2(1 - axis, axis);
        ivec2 before = pixel - offset;
        ivec2 behind = pixel + offset;
        if (before != max(before, ivec2(0)) || behind != min(behind, last))
            break;
        vec2 a = texelFetch(surfaces, before, 0).xy;
        vec2 b = texelFetch(surfaces, behind, 0).xy;
        float even = 1.0 - abs(a.x - 2.0 * surface.x + b.x) / most;
        if (a.y != surface.y || b.y != surface.y || even <= 0.0)
            break;
        float weight = even * (1.0 - float(i) / float(radius + 1));
        sum += weight * (a.x + b.x);
        weights += 2.0 * weight;
    }
    surface.x = sum / weights;
}
)";

/// A difference of depths is about one of u times depth squared. At a silhouette the side that goes
/// on smoothly is the one with the smaller difference. Behind the edge of the picture the surface
/// goes on straight.
static constexpr const char *shade_shader = R"(#version 330
uniform sampler2D surfaces;
uniform sampler2D table;
uniform vec3 lookup; // Base, scale and offset.
uniform vec4 view;
uniform vec3 background;
uniform float depth_step;
uniform bool silhouettes;
layout(location = 0) out vec4 color;

float u;
bool silhouette = false;

float difference(ivec2 pixel, ivec2 direction)
{
    ivec2 last = textureSize(surfaces, 0) - 1;
    ivec2 before = pixel - direction;
    ivec2 behind = pixel + direction;
    bool no_before = before != clamp(before, ivec2(0), last);
    bool no_behind = behind != clamp(behind, ivec2(0), last);
    float a = texelFetch(surfaces, no_before ? pixel : before, 0).x;
    float b = texelFetch(surfaces, no_behind ? pixel : behind, 0).x;
    if (no_before)
        a = 2.0 * u - b;
    if (no_behind)
        b = no_before ? u : 2.0 * u - a;
    float second = a - 2.0 * u + b;
    silhouette = silhouette || second < -2.0 * depth_step * u * u;
    if (abs(second) <= 2.0 * depth_step * u * u)
        return 0.5 * (b - a);
    return abs(b - u) < abs(u - a) ? b - u : u - a;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 surface = texelFetch(surfaces, pixel, 0).xy;
    u = surface.x;
    if (u == 0.0) {
        color = vec4(background, 0.0);
        return;
    }
    vec2 xy = (2.0 * gl_FragCoord.xy / view.xy - 1.0) * view.zw;
    vec2 gradient = vec2(difference(pixel, ivec2(1, 0)), difference(pixel, ivec2(0, 1))) *
                    view.xy / (2.0 * view.zw);
    vec3 normal = vec3(-gradient, u - dot(xy, gradient));
    // The light is at the eye: the cosine is that of the angle between the normal and the ray.
    float cosine = u * inversesqrt(dot(normal, normal) * (1.0 + dot(xy, xy)));
    vec3 base = texture(table, vec2((surface.y - lookup.x) * lookup.y + lookup.z, 0.75)).rgb;
    float light = silhouettes && silhouette ? 0.0 : 0.15 + 0.85 * min(cosine, 1.0);
    color = vec4(base * light, 1.0);
}
)";

Result<ShadingPass> ShadingPass::make(const Gl &gl, const ShadingSettings &settings)
{
    auto gather = Program::make(gl, full_screen_vertex_shader, gather_shader);
    if (!gather)
        return gather.error();
    auto smooth = Program::make(gl, full_screen_vertex_shader, smooth_shader);
    if (!smooth)
        return smooth.error();
    auto shade = Program::make(gl, full_screen_vertex_shader, shade_shader);
    if (!shade)
        return shade.error();
    ShadingPass pass(gl, settings, {std::move(*gather), std::move(*smooth), std::move(*shade)});
    for (std::size_t i = 0; i < pass.surfaces_.size(); ++i) {
        gl.BindFramebuffer(GL_FRAMEBUFFER, pass.framebuffers_[i].id());
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                                pass.surfaces_[i].id(), 0);
        if (auto complete = check_framebuffer(gl); !complete)
            return complete.error();
    }
    return pass;
}

static std::array<Texture, 2> make_surfaces(const Gl &gl, Size size)
{
    return {make_texture_2d(gl, GL_RG32F, size.width, size.height),
            make_texture_2d(gl, GL_RG32F, size.width, size.height)};
}

ShadingPass::ShadingPass(const Gl &gl, const ShadingSettings &settings, Programs programs)
    : settings_(settings), programs_(std::move(programs)), empty_(gl),
      surfaces_(make_surfaces(gl, settings.size)), framebuffers_{Framebuffer(gl), Framebuffer(gl)}
{
}

void ShadingPass::draw(const CapturedSurfaces &captured, const OrbitCamera &camera,
                       GLuint framebuffer) const
{
    const Gl &gl = empty_.gl();
    const Size size = settings_.size;
    gl.Viewport(0, 0, size.width, size.height);
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_BLEND);

    const glm::mat4 projection = camera.projection(size);
    const auto set_view = [&](const Program &program) {
        gl.Uniform4f(program.uniform("view"), static_cast<float>(size.width),
                     static_cast<float>(size.height), 1.0F / projection[0][0],
                     1.0F / projection[1][1]);
    };
    const auto draw_into = [&](GLuint target) {
        gl.BindFramebuffer(GL_FRAMEBUFFER, target);
        draw_full_screen(gl, empty_);
    };

    programs_.gather.use();
    set_view(programs_.gather);
    const int attachment = captured.entry % captured.kbuffer.attachments();
    gl.Uniform1i(programs_.gather.uniform("entries"), attachment);
    gl.Uniform1i(programs_.gather.uniform("layer"),
                 captured.entry / captured.kbuffer.attachments());
    captured.kbuffer.bind_textures();
    draw_into(framebuffers_[0].id());

    if (settings_.smoothing > 0) {
        programs_.smooth.use();
        gl.Uniform1i(programs_.smooth.uniform("radius"), settings_.smoothing);
        gl.Uniform1f(programs_.smooth.uniform("depth_step"), settings_.depth_step);
        for (const int axis : {0, 1}) {
            gl.Uniform1i(programs_.smooth.uniform("axis"), axis);
            gl.BindTexture(GL_TEXTURE_2D, surfaces_[std::size_t(axis)].id());
            draw_into(framebuffers_[std::size_t(1 - axis)].id());
        }
    }

    programs_.shade.use();
    set_view(programs_.shade);
    gl.Uniform3f(programs_.shade.uniform("lookup"), captured.base, captured.scale, captured.offset);
    gl.Uniform3f(programs_.shade.uniform("background"), settings_.background.r,
                 settings_.background.g, settings_.background.b);
    gl.Uniform1f(programs_.shade.uniform("depth_step"), settings_.depth_step);
    gl.Uniform1i(programs_.shade.uniform("silhouettes"), settings_.silhouettes);
    gl.Uniform1i(programs_.shade.uniform("table"), 1);
    gl.BindTexture(GL_TEXTURE_2D, surfaces_[0].id());
    gl.ActiveTexture(GL_TEXTURE1);
    gl.BindTexture(GL_TEXTURE_2D, captured.table.id());
    gl.ActiveTexture(GL_TEXTURE0);
    draw_into(framebuffer);
}

} // namespace kb
