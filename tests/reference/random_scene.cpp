// SPDX-License-Identifier: MIT

#include "tests/reference/random_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

namespace kb::reference
{

namespace
{

/// A corner as it is to be seen: in 1/256 pixel, and depth from 0 to 1 in the depth range.
struct Place {
    int x;
    int y;
    double depth;
    double w;
};

class SceneMaker
{
public:
    SceneMaker(std::uint64_t seed, const SceneLimits &limits) : random_(seed), limits_(limits) {}

    Scene make()
    {
        choose_form();
        choose_extension();
        choose_depths();
        choose_colors();
        add_steps();
        return scene_;
    }

private:
    void choose_form()
    {
        const int most = random_.one_in(25) ? 150 : random_.one_in(3) ? 48 : 20;
        scene_.samples = limits_.samples > 0 && random_.one_in(4) ? limits_.samples : 0;
        // Tall textures carry the samples out.
        scene_.width = random_.number(1, most);
        scene_.height = random_.number(1, scene_.samples > 0 ? std::min(most, 40) : most);
        if (limits_.several_tiles) {
            scene_.width = random_.number(65, 150);
            scene_.height = random_.number(65, scene_.samples > 0 ? 90 : 150);
        }
        scene_.k = random_.any_of(std::array{1, 2, 3, 4, 4, 5, 6, 8, 8, 12, 16, 17, 24});
        scene_.viewport = {0, 0, scene_.width, scene_.height};
        if (!limits_.even_grid && random_.one_in(5))
            scene_.viewport = {random_.number(-8, 8), random_.number(-8, 8),
                               random_.number(1, 2 * most), random_.number(1, 2 * most)};
    }

    void choose_extension()
    {
        if (random_.one_in(3)) {
            scene_.extension = Extension::program;
            scene_.layout = random_.any_of(std::array{EntryLayout::rgbz, EntryLayout::rgbz,
                                                      EntryLayout::packed, EntryLayout::packed,
                                                      EntryLayout::depth, EntryLayout::depth4});
            if (scene_.layout == EntryLayout::rgbz && random_.one_in(6))
                scene_.color_mask = {random_.one_in(2), random_.one_in(2), random_.one_in(2), true};
            return;
        }
        scene_.func = random_.any_of(std::array{Func::less, Func::less, Func::less, Func::lequal,
                                                Func::greater, Func::gequal});
        scene_.depth_format = random_.any_of(
            std::array{DepthFormat::d32f, DepthFormat::d32f, DepthFormat::d16, DepthFormat::d24});
        static const std::vector<std::vector<ColorFormat>> attachments{
            {ColorFormat::rgba32f, ColorFormat::r32ui},
            {ColorFormat::rgba8, ColorFormat::r32ui},
            {ColorFormat::rgba16f},
            {ColorFormat::r32ui},
            {ColorFormat::rgba8, ColorFormat::rgb10_a2, ColorFormat::r8},
            {ColorFormat::r32ui, ColorFormat::rgba16f, ColorFormat::rgba8, ColorFormat::rgba32f},
            {}};
        scene_.color_formats = random_.any_of(attachments);
        const bool ranks = scene_.func == Func::less || scene_.func == Func::greater;
        scene_.all_passes = ranks && random_.one_in(2);
        scene_.clear_depth = scene_.farthest_first() ? 0.0F : 1.0F;
        if (random_.one_in(8))
            scene_.clear_depth = scene_.farthest_first() ? 0.25F : 0.75F;
        if (random_.one_in(8))
            scene_.color_mask = {random_.one_in(2), random_.one_in(2), random_.one_in(2),
                                 random_.one_in(2)};
    }

    void choose_depths()
    {
        scene_.zero_to_one = random_.one_in(3);
        switch (random_.number(0, 9)) {
        case 0:
            scene_.depth_range = {1.0, 0.0};
            break;
        case 1: // All equal.
            scene_.depth_range = {0.3, 0.3};
            break;
        case 2:
            scene_.depth_range = {0.25, 0.5};
            break;
        default:
            break;
        }
        // Few different depths make ties between any triangles.
        coarse_depths_ = random_.one_in(3) ? random_.number(1, 6) : 0;
        perspective_ = !limits_.even_grid && random_.one_in(2);
    }

    void choose_colors()
    {
        scene_.flat = random_.one_in(2);
        alphas_ = random_.number(0, 3);
    }

    float channel() { return static_cast<float>(random_.number(0, 255)) / 255.0F; }

    std::array<float, 4> color()
    {
        std::array<float, 4> rgba{channel(), channel(), channel(), channel()};
        if (alphas_ == 0)
            rgba[3] = static_cast<float>(random_.number(0, 1));
        else if (alphas_ == 1 && random_.one_in(2))
            rgba[3] = random_.any_of(std::array{0.0F, 0.25F, 0.5F, 1.0F});
        else if (alphas_ == 2)
            rgba[3] = static_cast<float>(random_.number(0, 40)) / 255.0F;
        return rgba;
    }

    double depth()
    {
        if (coarse_depths_ > 0)
            return (0.5 + random_.number(0, coarse_depths_ - 1)) / coarse_depths_;
        return random_.between(0.002, 0.998);
    }

    double w() { return perspective_ ? random_.between(0.2, 5.0) : 1.0; }

    /// A coordinate in the viewport, in 1/256 pixel.
    int coordinate(int from, int size)
    {
        int x = random_.number(0, 256 * size);
        if (random_.one_in(4)) // Edges through samples.
            x = x / 128 * 128;
        if (limits_.even_grid)
            x = x / 4 * 4;
        return 256 * from + x;
    }

    Place place()
    {
        const Box &v = scene_.viewport;
        return {coordinate(v.x, v.width), coordinate(v.y, v.height), depth(), w()};
    }

    std::array<Place, 3> sliver()
    {
        std::array<Place, 3> places{place(), place(), place()};
        // The third corner beside the line between the others.
        const double t = random_.between(-0.2, 1.2);
        const auto along = [t](int a, int b) { return static_cast<int>(a + t * (b - a)); };
        places[2].x = along(places[0].x, places[1].x) + random_.number(-2, 2);
        places[2].y = along(places[0].y, places[1].y) + random_.number(-2, 2);
        return places;
    }

    std::array<float, 4> clip_position(const Place &place)
    {
        const Box &v = scene_.viewport;
        // Far enough from the middle of two steps of 1/256 that rounding does not matter, and not
        // on them: what is interpolated starts at the corner as it is.
        const auto window = [&](int x) {
            return x / 256.0 + (limits_.even_grid ? 0.0 : random_.between(-1.0, 1.0) / 1024.0);
        };
        const double x = (window(place.x) - v.x) / v.width * 2.0 - 1.0;
        const double y = (window(place.y) - v.y) / v.height * 2.0 - 1.0;
        const double z = scene_.zero_to_one ? place.depth : 2.0 * place.depth - 1.0;
        return {static_cast<float>(x * place.w), static_cast<float>(y * place.w),
                static_cast<float>(z * place.w), static_cast<float>(place.w)};
    }

    Triangle triangle_of(const std::array<Place, 3> &places)
    {
        Triangle triangle{next_id_++, {}};
        for (std::size_t i = 0; i < 3; ++i)
            triangle.vertices[i] = {clip_position(places[i]), color()};
        return triangle;
    }

    /// Through the near plane, or past the eye, by a camera at the origin.
    Triangle clipped_triangle()
    {
        Triangle triangle{next_id_++, {}};
        const double near = 0.1;
        const double far = 10.0;
        for (Vertex &vertex : triangle.vertices) {
            const double x = random_.between(-2.0, 2.0);
            const double y = random_.between(-2.0, 2.0);
            const double away = random_.between(-1.0, 4.0);
            const double z = scene_.zero_to_one
                                 ? far / (far - near) * (away - near)
                                 : ((far + near) * away - 2.0 * far * near) / (far - near);
            vertex = {{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z),
                       static_cast<float>(away)},
                      color()};
        }
        return triangle;
    }

    /// A corner beyond the viewport, or the far plane.
    Triangle overlapping_triangle()
    {
        std::array<Place, 3> places{place(), place(), place()};
        Place &out = places[std::size_t(random_.number(0, 2))];
        if (random_.one_in(3)) {
            out.depth = random_.one_in(2) ? 1.5 : -0.25;
        } else {
            out.x += 256 * random_.number(-scene_.width, scene_.width);
            out.y += 256 * random_.number(-scene_.height, scene_.height);
        }
        return triangle_of(places);
    }

    Triangle recolored(Triangle triangle)
    {
        triangle.id = next_id_++;
        for (Vertex &vertex : triangle.vertices)
            vertex.color = color();
        return triangle;
    }

    /// Adds one triangle, or some that belong together.
    void add_triangles(std::vector<Triangle> &out)
    {
        switch (random_.number(0, 13)) {
        case 0:
        case 1: // The same again, or from another corner, or the other way round.
            if (!all_.empty()) {
                Triangle again = recolored(random_.any_of(all_));
                std::rotate(again.vertices.begin(), again.vertices.begin() + random_.number(0, 2),
                            again.vertices.end());
                if (random_.one_in(3))
                    std::swap(again.vertices[0], again.vertices[1]);
                out.push_back(again);
            }
            break;
        case 2:
            out.push_back(triangle_of(sliver()));
            break;
        case 3: { // A quad in the plane of the screen, cut along a diagonal.
            Place a = place();
            Place c = place();
            c.depth = a.depth;
            c.w = a.w;
            const Place b{c.x, a.y, a.depth, a.w};
            const Place d{a.x, c.y, a.depth, a.w};
            out.push_back(triangle_of({a, b, c}));
            out.push_back(triangle_of({c, d, a}));
            if (random_.one_in(2)) { // And along the other.
                out.push_back(triangle_of({b, c, d}));
                out.push_back(triangle_of({d, a, b}));
            }
            break;
        }
        case 4: { // A fan around a point.
            const Place middle = place();
            Place before = place();
            for (int i = random_.number(2, 4); i > 0; --i) {
                const Place next = place();
                out.push_back(triangle_of({middle, before, next}));
                before = next;
            }
            break;
        }
        case 5:
            if (!limits_.even_grid && random_.one_in(2))
                out.push_back(clipped_triangle());
            break;
        case 6:
            if (!limits_.even_grid)
                out.push_back(overlapping_triangle());
            break;
        default: {
            std::array<Place, 3> places{place(), place(), place()};
            if (random_.one_in(4)) // Parallel to the screen.
                places[1].depth = places[2].depth = places[0].depth;
            out.push_back(triangle_of(places));
        }
        }
    }

    std::optional<Box> scissor()
    {
        if (!random_.one_in(4))
            return std::nullopt;
        return Box{random_.number(-2, scene_.width), random_.number(-2, scene_.height),
                   random_.number(0, scene_.width + 2), random_.number(0, scene_.height + 2)};
    }

    void add_steps()
    {
        const int most = random_.one_in(4) && !limits_.several_tiles ? 40 : 14;
        const int triangles = random_.number(1, most);
        while (static_cast<int>(all_.size()) < triangles) {
            Step step;
            if (!scene_.all_passes && !scene_.steps.empty() && random_.one_in(10)) {
                step.clear = true;
                // Stock drivers round another clear value in a scissor box than in whole buffers.
                if (scene_.clear_depth == 0.0F || scene_.clear_depth == 1.0F)
                    step.scissor = scissor();
                scene_.steps.push_back(step);
                continue;
            }
            step.scissor = scissor();
            step.depth_mask = !random_.one_in(12);
            if (random_.one_in(6))
                step.cull = random_.one_in(2) ? Cull::front : Cull::back;
            for (int i = random_.number(1, random_.one_in(3) ? 20 : 4); i > 0; --i) {
                const std::size_t before = step.triangles.size();
                add_triangles(step.triangles);
                all_.insert(all_.end(),
                            step.triangles.begin() + static_cast<std::ptrdiff_t>(before),
                            step.triangles.end());
            }
            scene_.steps.push_back(step);
        }
    }

    Random random_;
    SceneLimits limits_;
    Scene scene_;
    std::vector<Triangle> all_;
    std::uint32_t next_id_ = 1;
    int coarse_depths_ = 0;
    int alphas_ = 0;
    bool perspective_ = false;
};

} // namespace

Scene random_scene(std::uint64_t seed, const SceneLimits &limits)
{
    return SceneMaker(seed, limits).make();
}

} // namespace kb::reference
