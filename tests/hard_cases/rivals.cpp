// SPDX-License-Identifier: MIT

#include "tests/hard_cases/rivals.hpp"

#include "tests/hard_cases/cases.hpp"
#include "tests/hard_cases/rival_methods.hpp"

#include "bench/background.hpp"
#include "bench/capture.hpp"
#include "bench/gl_scene.hpp"
#include "bench/renderer.hpp"
#include "lib/gl/kbuffer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace kb::hard
{

using bench::must;

namespace
{

struct Rival {
    std::string_view name;
    int max_k;
};

constexpr float epsilon = 1e-7F; ///< That of VTK's dual depth peeling.

constexpr std::array rivals{
    Rival{"classic peeling, strict", 64},
    Rival{"dual peeling, epsilon 1e-7", 64},
    Rival{"framebuffer fetch", 16},
    Rival{"linked list", 64},
    Rival{"k+-buffer", 64},
};

std::unique_ptr<bench::Renderer> make_rival(const Gl &gl, std::string_view name, Size size, int k)
{
    if (name == "classic peeling, strict")
        return bench::make_classic_peeling(gl, size, k);
    if (name == "dual peeling, epsilon 1e-7")
        return bench::make_dual_peeling(gl, size, k, epsilon);
    if (name == "framebuffer fetch")
        return bench::make_fbfetch(gl, size, k);
    if (name == "linked list")
        return bench::make_linked_list(gl, size, k);
    return bench::make_k_plus(gl, "", size, k);
}

/// The colors that a scene's attributes stand for.
bench::StudyScene to_study_scene(const Scene &scene, bool black)
{
    bench::StudyScene result{.mesh = scene.mesh, .projection = scene.projection, .note = {}};
    for (glm::vec4 &color : result.mesh.colors) {
        const float value = black ? 0.0F : color.r;
        color = {value, value, value, color.g};
    }
    return result;
}

ImageRgbaF draw(const Gl &gl, bench::Renderer &renderer, const bench::StudyScene &scene, Size size)
{
    const Texture color = make_texture_2d(gl, GL_RGBA32F, size.width, size.height);
    const Framebuffer framebuffer(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.id(), 0);
    gl.Viewport(0, 0, size.width, size.height);
    const bench::GlScene in_gl(gl, scene);
    renderer.draw(in_gl, framebuffer.id());
    must(check_gl(gl, "drawing"));
    return read_color(gl, framebuffer.id(), size);
}

/// A case whose pixels are all to be alike: one of some lists of fragments, nearest first. Values
/// and alphas are multiples of 1/255, as the methods keep eight bits.
struct RivalCase {
    int number;
    int k;
    Scene scene;
    std::vector<std::vector<Attributes>> accepted;
    void (*set_state)(const Gl &, bool begin) = nullptr;
};

bench::Fragment to_fragment(const Attributes &attributes)
{
    const auto value = static_cast<float>(attributes.value);
    return {{value, value, value, static_cast<float>(attributes.alpha)}, 0.0F};
}

glm::dvec3 composite(const std::vector<Attributes> &list)
{
    std::vector<bench::Fragment> fragments;
    std::ranges::transform(list, std::back_inserter(fragments), to_fragment);
    return bench::composite(fragments, bench::all_fragments);
}

/// What the composite of k layers is off by in single precision: see the benchmark's tests.
double tolerance(int k)
{
    return k * 2.0 * std::ldexp(1.0, -22);
}

Outcome measure_rival(const Gl &gl, const RivalCase &own, const Rival &rival)
{
    const auto renderer = make_rival(gl, rival.name, usual_size, own.k);
    const auto in_state = [&](bool black) {
        if (own.set_state)
            own.set_state(gl, true);
        auto picture = draw(gl, *renderer, to_study_scene(own.scene, black), usual_size);
        if (own.set_state)
            own.set_state(gl, false);
        return picture;
    };
    // Black layers let so much of the background through as alpha says.
    const ImageRgbaF black = in_state(true);
    const ImageRgbaF colored = in_state(false);
    std::vector<glm::dvec3> accepted;
    std::ranges::transform(own.accepted, std::back_inserter(accepted), composite);
    double transmittance = 1.0;
    for (const Attributes &layer : own.accepted.front())
        transmittance *= 1.0 - layer.alpha;

    std::size_t wrong = 0;
    double worst_alpha = 1.0 - transmittance;
    for (std::size_t p = 0; p < colored.pixels.size(); ++p) {
        const bool right = std::ranges::any_of(accepted, [&](const glm::dvec3 &color) {
            return std::abs(static_cast<double>(colored.pixels[p].r) - color.r) <= tolerance(own.k);
        });
        wrong += right ? 0 : 1;
        const double alpha = 1.0 - static_cast<double>(black.pixels[p].r) / bench::background.r;
        if (std::abs(alpha - (1.0 - transmittance)) > std::abs(worst_alpha - (1.0 - transmittance)))
            worst_alpha = alpha;
    }
    Outcome outcome{
        {"alpha of the worst pixel", 1.0 - transmittance, worst_alpha,
         tolerance(own.k) / bench::background.r},
        {"wrong pixels, %", 0.0,
         100.0 * static_cast<double>(wrong) / static_cast<double>(colored.pixels.size())}};
    return outcome;
}

std::vector<RivalCase> uniform_cases()
{
    const auto plane = receding_plane();
    const std::array turned{plane[1], plane[2], plane[3], plane[0]};
    // What eight bits can hold: halves would be rounded up or down as they were interpolated.
    constexpr double half = 128.0 / 255.0;
    constexpr Attributes red{1.0, half, 1};
    constexpr Attributes blue{51.0 / 255.0, half, 2};
    std::vector<RivalCase> cases;

    RivalCase cuts{1, 4, {.projection = perspective()}, {{red, blue}, {blue, red}}};
    append_quad(cuts.scene.mesh, plane, red);
    append_quad(cuts.scene.mesh, turned, blue);
    cases.push_back(std::move(cuts));

    const Attributes quarter{1.0, 64.0 / 255.0, 1};
    RivalCase duplicates{
        2, 8, {.projection = perspective()}, {{quarter, quarter, quarter, quarter}}};
    for (int i = 0; i < 4; ++i)
        append_quad(duplicates.scene.mesh, plane, quarter);
    cases.push_back(std::move(duplicates));

    RivalCase ties{3, 4, {.projection = perspective()}, {{red, blue}}};
    append_quad(ties.scene.mesh, plane, red);
    append_quad(ties.scene.mesh, plane, blue);
    cases.push_back(std::move(ties));

    RivalCase many_ties{4, 40, {.projection = perspective()}, {{}}};
    for (int i = 0; i < 40; ++i) {
        const Attributes own{(6 * i + 5) / 255.0, 16.0 / 255.0, i};
        append_quad(many_ties.scene.mesh, plane, own);
        many_ties.accepted.front().push_back(own);
    }
    cases.push_back(std::move(many_ties));

    RivalCase neighbours{5, 16, {}, {{}}};
    std::vector<int> order;
    for (int i = 0; i < 16; ++i) {
        order.push_back(i);
        neighbours.accepted.front().push_back({i * 16 / 255.0, 32.0 / 255.0, i});
    }
    shuffle(order, 5);
    for (const int i : order)
        append_full(neighbours.scene.mesh, 0.75 + std::ldexp(i, -24),
                    neighbours.accepted.front()[static_cast<std::size_t>(i)]);
    cases.push_back(std::move(neighbours));

    RivalCase close{6, 4, {}, {{red, blue}}};
    append_full(close.scene.mesh, 0.9 + 1e-7, blue);
    append_full(close.scene.mesh, 0.9, red);
    cases.push_back(std::move(close));

    RivalCase flat{8, 12, {}, {{}}};
    for (int i = 0; i < 12; ++i) {
        const Attributes own{i * 20 / 255.0, 32.0 / 255.0, i};
        append_full(flat.scene.mesh, (i * 5 % 12 + 1) / 16.0, own);
        flat.accepted.front().push_back(own);
    }
    flat.set_state = [](const Gl &gl, bool begin) {
        gl.DepthRange(begin ? 0.3 : 0.0, begin ? 0.3 : 1.0);
    };
    cases.push_back(std::move(flat));
    return cases;
}

/// The rows of a case have its name and promise from the list of cases.
Row make_row(int number, std::string_view method)
{
    const auto cases = all_cases();
    const auto found = std::ranges::find(cases, number, &Case::number);
    return {number, found->name, found->promise, {}, std::string(method), {}, {}};
}

} // namespace

std::vector<Row> measure_rivals(const Gl &gl)
{
    std::vector<Row> rows;
    for (const RivalCase &own : uniform_cases()) {
        for (const Rival &rival : rivals) {
            Row row = make_row(own.number, rival.name);
            if (own.k > rival.max_k)
                row.why_not = fmt::format("{} fragments are its most", rival.max_k);
            else
                row.outcome = measure_rival(gl, own, rival);
            rows.push_back(std::move(row));
        }
    }
    Row blended = make_row(13, "blending in 8 bits");
    blended.outcome = blend_in_eight_bits(gl);
    rows.push_back(std::move(blended));
    Row edge = make_row(24, "classic peeling, strict");
    edge.outcome = peel_edge_with_samples(gl);
    rows.push_back(std::move(edge));
    return rows;
}

} // namespace kb::hard
