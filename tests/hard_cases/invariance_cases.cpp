// SPDX-License-Identifier: MIT
//
// What must not change the layers, with random scenes. Those of the driver's environment (threads,
// vector width, culling, shader cache) are compared by tests/hard_cases/run.

#include "tests/hard_cases/cases.hpp"
#include "tests/hard_cases/model.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace kb::hard
{

namespace
{

constexpr int many_passes = 100;

/// The exponent of two in a number that is not 0.
int twos(int number)
{
    return std::countr_zero(static_cast<unsigned>(std::abs(number)));
}

/// Whether an edge between whole pixels leaves all samples to one side. Those of llvmpipe, and the
/// centers, are at odd multiples of 1/8 or 1/2: one on the edge makes dx times something odd equal
/// to dy times something odd.
bool passes_between_samples(glm::ivec2 edge)
{
    return edge.x == 0 || edge.y == 0 || twos(edge.x) != twos(edge.y);
}

/// Large triangles one behind the other, each a little tilted, with vertices at whole pixels: their
/// edges are the same wherever they are, and no two depths are near each other.
Scene make_shingles(std::uint32_t seed, int count, Size size)
{
    Scene scene;
    std::mt19937 random(seed);
    const auto below = [&random](int n) { return static_cast<int>(random() % std::uint32_t(n)); };
    while (static_cast<int>(scene.mesh.triangle_count()) < count) {
        const auto id = static_cast<int>(scene.mesh.triangle_count());
        std::array<glm::ivec2, 3> places{};
        std::array<glm::vec3, 3> corners{};
        for (std::size_t c = 0; c < 3; ++c) {
            // Even: the middles of edges are whole pixels, too.
            places.at(c) = {2 * below(size.width / 2 + 1), 2 * below(size.height / 2 + 1)};
            const double depth = (id + 1 + below(64) / 256.0) / (count + 2);
            corners.at(c) = {2.0 * places.at(c).x / size.width - 1.0,
                             2.0 * places.at(c).y / size.height - 1.0, 2.0 * depth - 1.0};
        }
        const glm::ivec2 u = places[1] - places[0];
        const glm::ivec2 v = places[2] - places[0];
        // No slivers, whose depth would depend on how their edges are rounded.
        if (passes_between_samples(u) && passes_between_samples(v) &&
            passes_between_samples(u - v) &&
            std::abs(u.x * v.y - u.y * v.x) >= size.width * size.height / 4)
            append_triangle(scene.mesh, corners, {below(256) / 255.0, below(16) / 16.0, id});
    }
    return scene;
}

/// Equal depths in the order of their ids: what is left of arrival is not looked at.
Layers without_arrival(Layers layers)
{
    for (auto &fragments : layers)
        std::ranges::stable_sort(fragments, [](const Fragment &a, const Fragment &b) {
            return a.depth != b.depth ? a.depth < b.depth : a.id < b.id;
        });
    return layers;
}

Outcome permutation(const Gl &gl, Method &method, const Shape &shape)
{
    Scene scene = make_mixture(101);
    SceneInGl in_gl(gl, scene);
    const auto draw = [&] { in_gl.draw(); };
    const Layers first = without_arrival(method.draw(shape, draw));
    double different = 0.0;
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        std::vector<std::array<std::uint32_t, 3>> triangles;
        for (std::size_t i = 0; i < scene.mesh.indices.size(); i += 3)
            triangles.push_back(
                {scene.mesh.indices[i], scene.mesh.indices[i + 1], scene.mesh.indices[i + 2]});
        shuffle(triangles, seed);
        scene.mesh.indices.clear();
        for (const auto &triangle : triangles)
            scene.mesh.indices.insert(scene.mesh.indices.end(), triangle.begin(), triangle.end());
        in_gl.replace(scene.mesh);
        different += differing(without_arrival(method.draw(shape, draw)), first);
    }
    return {{"samples with other layers in any of 3 orders, %", 0.0, different}};
}

/// Of two layer lists: whether the same fragments are in the same order, and how far depths differ.
struct Agreement {
    double other_samples;
    double depth_difference;
};
Agreement compare_but_for_depth(const Layers &a, const Layers &b)
{
    Agreement agreement{0.0, 0.0};
    for (std::size_t i = 0; i < a.size(); ++i) {
        const auto same = [](const Fragment &x, const Fragment &y) {
            return x.id == y.id && x.value == y.value && x.alpha == y.alpha;
        };
        if (!std::ranges::equal(a[i], b[i], same)) {
            agreement.other_samples += 100.0 / static_cast<double>(a.size());
            continue;
        }
        for (std::size_t f = 0; f < a[i].size(); ++f)
            agreement.depth_difference =
                std::max(agreement.depth_difference, std::abs(a[i][f].depth - b[i][f].depth));
    }
    return agreement;
}

/// A driver computes a depth as z0 + x dz/dx + y dz/dy. Twice the area of a shingle is at least a
/// quarter of the view's 70x16 pixels (here as in the moved view of 40x16, relative to its sides),
/// no side is longer than its diagonal, so that each height is 3.7 pixels and more; depths differ
/// by less than 1/88 within a shingle: each gradient is below 2^-8. A gradient is a quotient of
/// differences of depths, which round by 2^-25 twice, over a height: off by 2^-25. Over 104 pixels
/// (the moved view's farthest) that is 2^-18.3 in the worst case; the products and sums, of numbers
/// up to 2^-1, add 5 * 2^-26. Both of two depths can be off by that.
constexpr double plane_tolerance = 0x1p-17;

Outcome tessellation(const Gl &gl, Method &method, const Shape &shape)
{
    const Scene whole = make_shingles(102, 20, shape.size);
    Scene cut = whole;
    cut.mesh.indices.clear();
    cut.mesh.positions.clear();
    cut.mesh.normals.clear();
    cut.mesh.colors.clear();
    for (std::size_t i = 0; i < whole.mesh.indices.size(); i += 3) {
        std::array<glm::vec3, 3> c{};
        for (std::size_t n = 0; n < 3; ++n)
            c.at(n) = whole.mesh.positions[whole.mesh.indices[i + n]];
        const glm::vec4 &color = whole.mesh.colors[whole.mesh.indices[i]];
        const Attributes own{color.r, color.g, static_cast<int>(color.b)};
        const auto middle = [&c](std::size_t a, std::size_t b) {
            return 0.5F * (c.at(a) + c.at(b));
        };
        const std::array m{middle(0, 1), middle(1, 2), middle(2, 0)};
        append_triangle(cut.mesh, {c[0], m[0], m[2]}, own);
        append_triangle(cut.mesh, {m[0], c[1], m[1]}, own);
        append_triangle(cut.mesh, {m[2], m[1], c[2]}, own);
        append_triangle(cut.mesh, m, own);
    }
    SceneInGl in_gl(gl, whole);
    const auto draw = [&] { in_gl.draw(); };
    const Layers of_whole = method.draw(shape, draw);
    in_gl.replace(cut.mesh);
    const Agreement agreement = compare_but_for_depth(of_whole, method.draw(shape, draw));
    return {{"samples with other fragments, %", 0.0, agreement.other_samples},
            {"depth, greatest difference", 0.0, agreement.depth_difference, plane_tolerance}};
}

Outcome tile_offset(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr Size view{40, 16};
    const Scene scene = make_shingles(103, 20, view);
    const SceneInGl in_gl(gl, scene);
    Shape own = shape;
    own.size = {view.width + 64, view.height + 64};
    const auto draw_at = [&](int offset) {
        const Layers all = method.draw(own, [&] {
            gl.Viewport(offset, offset, view.width, view.height);
            in_gl.draw();
        });
        // The view of each sample.
        Layers part;
        const std::size_t pixels = std::size_t(own.size.width) * std::size_t(own.size.height);
        for (std::size_t first = 0; first < all.size(); first += pixels)
            for (int y = 0; y < view.height; ++y)
                for (int x = 0; x < view.width; ++x)
                    part.push_back(all[first + std::size_t(y + offset) * own.size.width +
                                       std::size_t(x + offset)]);
        return part;
    };
    const Layers first = draw_at(0);
    Agreement worst{0.0, 0.0};
    for (const int offset : {1, 3, 4, 31, 63, 64}) {
        const Agreement agreement = compare_but_for_depth(draw_at(offset), first);
        worst = {std::max(worst.other_samples, agreement.other_samples),
                 std::max(worst.depth_difference, agreement.depth_difference)};
    }
    return {{"samples with other fragments at any of 6 offsets, %", 0.0, worst.other_samples},
            {"depth, greatest difference", 0.0, worst.depth_difference, plane_tolerance}};
}

/// Each triangle is followed by itself with alpha 0.
Outcome transparent_duplicates(const Gl &gl, Method &method, const Shape &shape)
{
    const Scene scene = make_shingles(104, 20, shape.size);
    Scene doubled;
    for (std::size_t i = 0; i < scene.mesh.indices.size(); i += 3) {
        std::array<glm::vec3, 3> c{};
        for (std::size_t n = 0; n < 3; ++n)
            c.at(n) = scene.mesh.positions[scene.mesh.indices[i + n]];
        const glm::vec4 &color = scene.mesh.colors[scene.mesh.indices[i]];
        append_triangle(doubled.mesh, c, {color.r, color.g, static_cast<int>(color.b)});
        append_triangle(doubled.mesh, c, {0.5, 0.0, static_cast<int>(color.b)});
    }
    SceneInGl in_gl(gl, scene);
    const auto draw = [&] { in_gl.draw(); };
    const Layers once = method.draw(shape, draw);
    in_gl.replace(doubled.mesh);
    const Layers twice = method.draw(shape, draw);
    double changed = 0.0;
    double lost = 0.0;
    for (std::size_t i = 0; i < once.size(); ++i) {
        changed += composite_front_to_back(once[i]) == composite_front_to_back(twice[i]) ? 0 : 1;
        lost += 2 * once[i].size() == twice[i].size() ? 0 : 1;
    }
    const auto count = static_cast<double>(once.size());
    return {{"samples whose composite changes a bit, %", 0.0, 100.0 * changed / count},
            {"samples without twice as many fragments, %", 0.0, 100.0 * lost / count}};
}

/// What k layers leave out of alpha is the light behind the last, times what the rest takes.
Outcome error_against_k(const Gl &gl, Method &method, const Shape &shape)
{
    const Scene scene = make_mixture(105);
    const SceneInGl in_gl(gl, scene);
    const Layers all = sorted_fragments(gl, scene, in_gl, shape);
    std::vector<double> with_more(all.size(), 0.0);
    double shrunk = 0.0;
    double other_counts = 0.0;
    double greatest_with_all = 0.0;
    Shape own = shape;
    const auto most = static_cast<int>(deepest(all));
    for (own.k = most; own.k > 0; own.k -= own.k > 8 ? 7 : 1) {
        const Layers layers = method.draw(own, [&] { in_gl.draw(); });
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double error = std::abs(coverage(layers[i]) - coverage(all[i]));
            shrunk += error < with_more[i] ? 1.0 : 0.0;
            other_counts += layers[i].size() == std::min(all[i].size(), std::size_t(own.k)) ? 0 : 1;
            if (own.k == most)
                greatest_with_all = std::max(greatest_with_all, error);
            with_more[i] = error;
        }
    }
    return {{"samples and k whose error is less than with more layers", 0.0, shrunk},
            {"samples and k with another number of layers", 0.0, other_counts},
            {"greatest error with all layers", 0.0, greatest_with_all}};
}

Outcome a_buffer(const Gl &gl, Method &method, const Shape &shape)
{
    const Scene scene = make_mixture(106);
    const SceneInGl in_gl(gl, scene);
    const Layers all = sorted_fragments(gl, scene, in_gl, shape);
    Outcome outcome;
    for (const int more : {0, 1}) {
        Shape own = shape;
        own.k = static_cast<int>(deepest(all)) + more;
        outcome.push_back({more == 0 ? "k = depth complexity: samples unlike the A-buffer, %"
                                     : "k = depth complexity + 1: samples unlike the A-buffer, %",
                           0.0, differing(method.draw(own, [&] { in_gl.draw(); }), all)});
    }
    return outcome;
}

Outcome passes(const Gl &gl, Method &method, const Shape &shape)
{
    const Scene scene = make_mixture(107);
    const SceneInGl in_gl(gl, scene);
    Shape large = shape;
    large.k = 64;
    const Layers all = method.draw(large, [&] { in_gl.draw(); });
    double different = 0.0;
    for (const int k : {1, 4, 10}) {
        Shape own = shape;
        own.k = k;
        const auto small = method.draw_passes(own, many_passes, [&] { in_gl.draw(); });
        for (std::size_t p = 0; p < small.size(); ++p)
            different += differing(small[p].layers, cut_out(all, k * static_cast<int>(p), k));
    }
    return {{"samples of passes of k = 1, 4, 10 unlike the layers of k = 64, %", 0.0, different}};
}

} // namespace

std::vector<Case> invariance_cases()
{
    // Two tiles of llvmpipe, and few pixels: the deepest have some 50 layers.
    constexpr Size strip{70, 16};
    const auto mixtures = with_and_without_samples({{"", {.k = 64, .size = strip}}});
    const auto shingles = with_and_without_samples({{"", {.k = 24, .size = strip}}});
    return {
        {0, "permutation of the draw order", "The same layers, but for the order of equal depths",
         mixtures, permutation, "", false},
        {0, "tessellation of a triangle",
         "Each triangle cut into four: the same fragments in the same order, depths within what "
         "planes through other vertices round",
         shingles, tessellation},
        {0, "tile offset",
         "The viewport moved by 1 to 64 pixels: the same fragments in the same order, depths "
         "within what the planes round elsewhere",
         shingles, tile_offset},
        {0, "duplicates with alpha 0", "No bit of a composite changes", mixtures,
         transparent_duplicates, "", false},
        {0, "error against k", "The error of the composite never grows with k", mixtures,
         error_against_k, "", false},
        {0, "k at least the depth complexity", "The layers are those of an A-buffer", mixtures,
         a_buffer},
        {0, "passes", "Pass p of several equals the layers of one larger pass", mixtures, passes,
         "no further pass goes on behind the last entry"},
    };
}

} // namespace kb::hard
