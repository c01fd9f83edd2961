// SPDX-License-Identifier: MIT

#include "tests/reference/invariances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace kb::reference
{

namespace
{

using Finding = std::optional<std::string>;

/// A scene, what the driver made of it, and its fragments by rank: those of all passes in a row.
class Drawn
{
public:
    static Result<Drawn> make(SceneDrawer &drawer, const Scene &scene)
    {
        auto rules = drawer.rules(scene);
        if (!rules)
            return rules.error();
        auto seen = observe(drawer, scene);
        if (!seen)
            return seen.error();
        return Drawn(scene, std::move(*seen), std::move(*rules));
    }

    const Scene &scene() const { return scene_; }
    const Observation &seen() const { return seen_; }
    std::size_t samples_a_layer() const { return seen_.a_buffer.sample_count(); }
    std::size_t ranks() const { return seen_.passes.size() * k(); }
    std::size_t sample_at(int x, int y, int sample) const
    {
        return (std::size_t(y) * std::size_t(scene_.width) + std::size_t(x)) *
                   std::size_t(scene_.sample_count()) +
               std::size_t(sample);
    }

    std::uint32_t depth(std::size_t rank, std::size_t sample) const
    {
        return pass(rank).depth[rank % k() * samples_a_layer() + sample];
    }

    const Color &color(std::size_t attachment, std::size_t rank, std::size_t sample) const
    {
        return pass(rank).colors[attachment][rank % k() * samples_a_layer() + sample];
    }

    bool is_empty(std::size_t rank, std::size_t sample) const
    {
        const double clear =
            scene_.extension == Extension::peeling ? static_cast<double>(scene_.clear_depth) : 1.0;
        return depth(rank, sample) == encode_depth(kept_depth(scene_), clear);
    }

    /// How far the depths of this sample may be from exact ones: infinite if it is not known which
    /// triangles cover it.
    double tolerance(int x, int y, int sample) const
    {
        const SamplePosition position = rules_.samples[std::size_t(sample)];
        const DepthFormat format = kept_depth(scene_);
        double tolerance = 0.0;
        for (const TriangleRaster &raster : rasters_) {
            const Coverage coverage = raster.coverage(x, y, position);
            if (coverage == Coverage::undecided)
                return std::numeric_limits<double>::infinity();
            if (coverage == Coverage::yes)
                tolerance = std::max(tolerance, raster.depth(x, y, position).tolerance);
        }
        return tolerance +
               depth_step(format) * (format == DepthFormat::d16 ? rules_.steps_of_16_bits : 1);
    }

private:
    Drawn(const Scene &scene, Observation seen, RasterRules rules)
        : scene_(scene), seen_(std::move(seen)), rules_(std::move(rules))
    {
        for (const Step &step : scene_.steps) {
            for (const Triangle &triangle : step.triangles)
                rasters_.emplace_back(scene_, step.cull, triangle, rules_);
        }
    }

    std::size_t k() const { return static_cast<std::size_t>(scene_.k); }
    const Pass &pass(std::size_t rank) const { return seen_.passes[rank / k()]; }

    Scene scene_;
    Observation seen_;
    RasterRules rules_;
    std::vector<TriangleRaster> rasters_;
};

std::string place(const Drawn &drawn, std::size_t sample)
{
    const auto samples = static_cast<std::size_t>(drawn.scene().sample_count());
    const auto width = static_cast<std::size_t>(drawn.scene().width);
    return fmt::format("pixel ({}, {}) sample {}", sample / samples % width,
                       sample / samples / width, sample % samples);
}

/// The same depth and colors, bit for bit; behind the last rank of one the other is empty.
Finding compare_sample(const Drawn &a, const Drawn &b, std::size_t sample)
{
    for (std::size_t rank = 0; rank < std::max(a.ranks(), b.ranks()); ++rank) {
        if (rank >= a.ranks() || rank >= b.ranks()) {
            if (!(rank < a.ranks() ? a : b).is_empty(rank, sample))
                return fmt::format("{}: only one has rank {}", place(a, sample), rank);
            continue;
        }
        bool same = a.depth(rank, sample) == b.depth(rank, sample);
        // Programs leave what they like in empty places.
        if (!a.is_empty(rank, sample) || a.scene().extension == Extension::peeling) {
            for (std::size_t c = 0; c < kept_colors(a.scene()).size(); ++c)
                same = same && std::memcmp(&a.color(c, rank, sample), &b.color(c, rank, sample),
                                           sizeof(Color)) == 0;
        }
        if (!same)
            return fmt::format("{}: rank {} differs", place(a, sample), rank);
    }
    return std::nullopt;
}

/// What is drawn differently rounds differently: fragments of the same rank have depths that are as
/// near as their bounds say (sorting cannot move them further apart), and integers are the same
/// where no neighbor is nearer than that. The picture b is moved by (dx, dy).
Finding compare_within_rounding(const Drawn &a, const Drawn &b, int dx, int dy)
{
    const Scene &scene = a.scene();
    const DepthFormat format = kept_depth(scene);
    const auto formats = kept_colors(scene);
    const auto id = std::find(formats.begin(), formats.end(), ColorFormat::r32ui);
    for (int y = 0; y < scene.height; ++y) {
        for (int x = 0; x < scene.width; ++x) {
            for (int s = 0; s < scene.sample_count(); ++s) {
                const double bound = a.tolerance(x, y, s) + b.tolerance(x + dx, y + dy, s);
                if (!std::isfinite(bound))
                    continue;
                const std::size_t i = a.sample_at(x, y, s);
                const std::size_t j = b.sample_at(x + dx, y + dy, s);
                const auto depth_of = [&](std::size_t rank) {
                    return decode_depth(format, a.depth(rank, i));
                };
                const std::size_t ranks = std::min(a.ranks(), b.ranks());
                for (std::size_t rank = 0; rank < ranks; ++rank) {
                    if (a.is_empty(rank, i) != b.is_empty(rank, j))
                        return fmt::format("{}: one has a fragment of rank {}", place(a, i), rank);
                    const double here = depth_of(rank);
                    const double there = decode_depth(format, b.depth(rank, j));
                    if (!(std::abs(here - there) <= bound))
                        return fmt::format("{}: depths of rank {} are {:.9g} and {:.9g}",
                                           place(a, i), rank, here, there);
                    // The last one may have a neighbor that is not kept.
                    const bool alone =
                        (rank == 0 || std::abs(here - depth_of(rank - 1)) > 2.0 * bound) &&
                        rank + 1 < ranks && std::abs(here - depth_of(rank + 1)) > 2.0 * bound;
                    const auto attachment = static_cast<std::size_t>(id - formats.begin());
                    if (alone && id != formats.end() &&
                        a.color(attachment, rank, i) != b.color(attachment, rank, j))
                        return fmt::format("{}: another triangle has rank {}", place(a, i), rank);
                }
            }
        }
    }
    return std::nullopt;
}

/// Draws two scenes and compares them.
template <class Compare>
Result<Finding> compare_scenes(SceneDrawer &drawer, const Scene &a, const Scene &b, Compare compare)
{
    // Only b can be too large to be read back; that says nothing about it.
    if (!check_scene(b))
        return Finding();
    auto drawn_a = Drawn::make(drawer, a);
    if (!drawn_a)
        return drawn_a.error();
    auto drawn_b = Drawn::make(drawer, b);
    if (!drawn_b)
        return drawn_b.error();
    return compare(*drawn_a, *drawn_b);
}

void remove_clears(Scene &scene)
{
    std::erase_if(scene.steps, [](const Step &step) { return step.clear; });
}

/// Fragments of different depths have the same place whenever they are drawn.
Result<Finding> order_of_drawing(SceneDrawer &drawer, std::uint64_t seed, const SceneLimits &limits)
{
    Scene scene = random_scene(seed, limits);
    remove_clears(scene);
    Scene shuffled = scene;
    Random random(seed);
    const auto shuffle = [&random](auto &items) {
        for (std::size_t i = items.size(); i > 1; --i)
            std::swap(items[i - 1], items[std::size_t(random.number(0, int(i) - 1))]);
    };
    shuffle(shuffled.steps);
    for (Step &step : shuffled.steps)
        shuffle(step.triangles);
    return compare_scenes(drawer, scene, shuffled, [](const Drawn &a, const Drawn &b) -> Finding {
        for (std::size_t i = 0; i < a.samples_a_layer(); ++i) {
            const auto &fragments = a.seen().a_buffer.at(i);
            const bool tied =
                std::adjacent_find(fragments.begin(), fragments.end(), [](auto &f, auto &g) {
                    return f.depth == g.depth;
                }) != fragments.end();
            if (auto found = tied ? std::nullopt : compare_sample(a, b, i))
                return found;
        }
        return std::nullopt;
    });
}

Vertex middle(const Vertex &a, const Vertex &b)
{
    Vertex vertex{};
    for (std::size_t c = 0; c < 4; ++c) {
        vertex.position[c] = 0.5F * (a.position[c] + b.position[c]);
        vertex.color[c] = 0.5F * (a.color[c] + b.color[c]);
    }
    return vertex;
}

/// A triangle and the same one in two parts, or in four, have the same fragments. Its corners are
/// at even multiples of 1/256 pixel, so that the middles are exactly on the edges.
Result<Finding> tessellation(SceneDrawer &drawer, std::uint64_t seed, const SceneLimits &limits)
{
    SceneLimits even = limits;
    even.even_grid = true;
    Scene scene = random_scene(seed, even);
    remove_clears(scene);
    // A depth at the clear value would be kept or not by rounding.
    scene.clear_depth = scene.farthest_first() ? 0.0F : 1.0F;
    scene.flat = true;
    Scene fine = scene;
    Random random(seed);
    for (Step &step : fine.steps) {
        std::vector<Triangle> parts;
        for (Triangle &t : step.triangles) {
            t.vertices[0].color = t.vertices[1].color = t.vertices[2].color;
            const auto &[a, b, c] = t.vertices;
            const Vertex ab = middle(a, b);
            const Vertex bc = middle(b, c);
            const Vertex ca = middle(c, a);
            const auto add = [&](const Vertex &p, const Vertex &q, const Vertex &r) {
                parts.push_back({t.id, {p, q, r}});
            };
            if (random.one_in(2)) {
                add(a, b, bc);
                add(a, bc, c);
            } else {
                add(a, ab, ca);
                add(ab, b, bc);
                add(ca, bc, c);
                add(ab, bc, ca);
            }
        }
        step.triangles = parts;
    }
    return compare_scenes(drawer, scene, fine, [](const Drawn &a, const Drawn &b) {
        return compare_within_rounding(a, b, 0, 0);
    });
}

/// A picture that is moved by whole pixels is the same picture: tiles and blocks cut it elsewhere.
Result<Finding> tile_offset(SceneDrawer &drawer, std::uint64_t seed, const SceneLimits &limits)
{
    SceneLimits even = limits;
    even.even_grid = true;
    Scene scene = random_scene(seed, even);
    remove_clears(scene);
    scene.clear_depth = scene.farthest_first() ? 0.0F : 1.0F;
    Random random(seed);
    const int dx = random.number(1, 64);
    const int dy = scene.samples > 0 ? random.number(0, 8) : random.number(1, 64);
    Scene moved = scene;
    moved.width += dx;
    moved.height += dy;
    moved.viewport.x += dx;
    moved.viewport.y += dy;
    for (Step &step : moved.steps) {
        if (step.scissor) {
            step.scissor->x += dx;
            step.scissor->y += dy;
        }
    }
    return compare_scenes(drawer, scene, moved, [dx, dy](const Drawn &a, const Drawn &b) {
        return compare_within_rounding(a, b, dx, dy);
    });
}

/// A scene with something to compose, in one pass of k layers, and colors that do not go below zero
/// beside a triangle.
Scene composed_scene(std::uint64_t seed, const SceneLimits &limits, int k)
{
    Scene scene = random_scene(seed, limits);
    remove_clears(scene);
    if (scene.extension == Extension::program)
        scene.layout = EntryLayout::packed;
    else if (!composed_attachment(scene))
        scene.color_formats = {ColorFormat::rgba32f};
    scene.color_mask = {true, true, true, true};
    scene.all_passes = false;
    scene.flat = true;
    scene.k = k;
    return scene;
}

Finding compare_composites(const Drawn &a, const Drawn &b, const char *what)
{
    const auto &left = a.seen().passes[0].composite;
    const auto &right = b.seen().passes[0].composite;
    for (std::size_t i = 0; i < left.size(); ++i) {
        if (std::memcmp(&left[i], &right[i], sizeof(Color)) != 0)
            return fmt::format("pixel {}: the composite differs {}", i, what);
    }
    return std::nullopt;
}

/// Fragments of alpha 0 change no bit of the composite.
Result<Finding> alpha_zero(SceneDrawer &drawer, std::uint64_t seed, const SceneLimits &limits)
{
    constexpr int k = 32;
    const Scene scene = composed_scene(seed, limits, k);
    Scene more = scene;
    Random random(seed);
    for (Step &step : more.steps) {
        std::vector<Triangle> with_copies;
        for (const Triangle &triangle : step.triangles) {
            Triangle copy = triangle;
            for (Vertex &vertex : copy.vertices)
                vertex.color[3] = 0.0F;
            if (random.one_in(3))
                with_copies.push_back(copy);
            with_copies.push_back(triangle);
            if (random.one_in(3))
                with_copies.push_back(copy);
        }
        step.triangles = with_copies;
    }
    return compare_scenes(drawer, scene, more, [](const Drawn &a, const Drawn &b) -> Finding {
        if (!b.seen().knows_all() || b.seen().a_buffer.deepest() > static_cast<std::size_t>(k))
            return std::nullopt; // They push others out.
        return compare_composites(a, b, "with fragments of alpha 0");
    });
}

/// Over black each layer adds something and lets less through, in floats as in numbers: rounding
/// does not change the order of sums. So with k the composite only comes nearer to that of all
/// layers, and with k of the depth complexity it is that, bit for bit; the layers are the A-buffer.
Result<Finding> more_layers(SceneDrawer &drawer, std::uint64_t seed, const SceneLimits &limits)
{
    Random random(seed);
    auto before = Drawn::make(drawer, composed_scene(seed, limits, random.number(1, 3)));
    if (!before)
        return before.error();
    if (!before->seen().knows_all())
        return Finding();
    const int deepest = std::clamp(static_cast<int>(before->seen().a_buffer.deepest()), 1, 60);
    const std::array<int, 3> more{std::min(before->scene().k + random.number(1, 4), deepest),
                                  deepest, deepest + random.number(1, 4)};
    for (const int k : more) {
        Scene scene = before->scene();
        if (k <= scene.k)
            continue;
        scene.k = k;
        auto after = Drawn::make(drawer, scene);
        if (!after)
            return after.error();
        const auto &few = before->seen().passes[0].composite;
        const auto &many = after->seen().passes[0].composite;
        for (std::size_t i = 0; i < few.size(); ++i) {
            for (std::size_t c = 0; c < 4; ++c) {
                if (c < 3 ? many[i][c] < few[i][c] : many[i][c] > few[i][c])
                    return Finding(fmt::format("pixel {}: k {} is further from all layers than {}",
                                               i, k, before->scene().k));
            }
        }
        if (before->scene().k >= static_cast<int>(before->seen().a_buffer.deepest())) {
            if (auto found = compare_composites(*before, *after, "with k above the complexity"))
                return found;
        }
        if (k >= static_cast<int>(before->seen().a_buffer.deepest())) {
            Statistics ignored;
            auto found = check(drawer, scene, Fault::none, ignored);
            if (!found || *found)
                return found;
        }
        before = std::move(after);
    }
    return Finding();
}

/// Layer i of pass p is layer p k + i of one pass that has room for all.
Result<Finding> one_larger_pass(SceneDrawer &drawer, std::uint64_t seed, const SceneLimits &limits)
{
    Scene scene = random_scene(seed, limits);
    if (scene.extension == Extension::program)
        return Finding();
    remove_clears(scene);
    scene.func = scene.farthest_first() ? Func::greater : Func::less;
    scene.all_passes = true;
    scene.k = std::min(scene.k, Random(seed).number(1, 6));
    Scene larger = scene;
    larger.all_passes = false;
    larger.k = std::clamp(static_cast<int>(scene.triangle_count()), 1, 60);
    return compare_scenes(drawer, scene, larger, [](const Drawn &a, const Drawn &b) -> Finding {
        if (!b.seen().knows_all() || b.seen().a_buffer.deepest() > b.ranks())
            return std::nullopt;
        for (std::size_t i = 0; i < a.samples_a_layer(); ++i) {
            if (auto found = compare_sample(a, b, i))
                return found;
        }
        return std::nullopt;
    });
}

constexpr std::array<Invariance, 6> all_invariances{{{"order of drawing", order_of_drawing},
                                                     {"tessellation", tessellation},
                                                     {"tile offset", tile_offset},
                                                     {"fragments of alpha 0", alpha_zero},
                                                     {"more layers", more_layers},
                                                     {"one larger pass", one_larger_pass}}};

} // namespace

std::span<const Invariance> invariances()
{
    return all_invariances;
}

std::uint64_t digest_of(const Observation &seen, std::uint64_t digest)
{
    // FNV-1a.
    const auto add = [&digest](const auto &values) {
        for (const std::byte byte : std::as_bytes(std::span(values)))
            digest = (digest ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3U;
    };
    for (const Pass &pass : seen.passes) {
        add(pass.depth);
        add(pass.composite);
        for (const auto &colors : pass.colors)
            add(colors);
    }
    return digest;
}

} // namespace kb::reference
