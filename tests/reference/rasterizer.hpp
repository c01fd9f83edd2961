// SPDX-License-Identifier: MIT
//
// Which samples a triangle covers, and the depth and color of its fragments, computed from the
// vertices in double precision and integers. Everything comes with what is known about it:
//
//   coverage  A driver that snaps vertices to 1/256 pixel (llvmpipe) decides by integers. So does
//             this, with the rule that it has for framebuffer objects: a sample on an edge is
//             covered if that is a left edge or a horizontal one at the bottom. The answer is
//             exact. For triangles that are clipped, whose new corners are rounded, and for a
//             driver that walks edges in floats (softpipe), samples nearer to the outline than the
//             rounding moves it are undecided; all others are exact. Where edges are walked this
//             holds for the whole row at the height of a corner, too: stock softpipe draws the rows
//             below and above the middle corner one after the other, and rounding can leave out the
//             one between them.
//
//   values    The value at the sample, and a bound on what the single-precision plane equations of
//             a driver may add to it (rasterizer.cpp derives it). It is infinite where a triangle
//             is so thin that its plane is lost in rounding.

#pragma once

#include "tests/reference/scene.hpp"

#include <array>
#include <limits>
#include <span>
#include <vector>

namespace kb::reference
{

enum class Coverage { no, yes, undecided };

struct Estimate {
    double value = 0.0;
    double tolerance = std::numeric_limits<double>::infinity();

    bool agrees_with(double measured) const
    {
        const double difference = measured - value;
        return (difference < 0.0 ? -difference : difference) <= tolerance;
    }
};

/// Where in a pixel a sample is, from its lower left corner, in 1/256 pixel: all that GL
/// implementations here have are multiples of that.
struct SamplePosition {
    int x = 128;
    int y = 128;
};

/// What the driver is known to do.
struct RasterRules {
    bool snaps = true;
    /// By how many steps of a 16-bit depth buffer the stored depth may be off. One comes from
    /// rounding down. softpipe interpolates up to 16 pixels of a row in integers, with a slope that
    /// is rounded down to one a pixel.
    int steps_of_16_bits = 1;
    std::vector<SamplePosition> samples{{}};
};

struct Point {
    double x = 0.0;
    double y = 0.0;
};

/// A corner in window coordinates, and how far a driver may be off.
struct Corner {
    Point at;
    double z = 0.0;
    double inverse_w = 1.0;
    std::array<double, 4> color{};
    double position_error = 0.0; ///< In pixels, of x and y each.
    double z_error = 0.0;
    double relative_error = 0.0; ///< Of color / w and 1 / w.
};

class TriangleRaster
{
public:
    TriangleRaster(const Scene &scene, Cull cull, const Triangle &triangle,
                   const RasterRules &rules);

    bool is_clipped() const { return clipped_; }

    /// Whether the sample is covered, by the triangle alone: the scissor box is not looked at.
    Coverage coverage(int px, int py, SamplePosition sample) const;

    /// The depth before it is converted to the format of a depth buffer.
    Estimate depth(int px, int py, SamplePosition sample) const;

    /// A channel of the color, at the pixel's center.
    Estimate color(int px, int py, std::size_t channel) const;

private:
    struct Edge {
        long long a, b, c; ///< a x + b y + c > 0 inside.
    };

    void make_edges(const RasterRules &rules, Cull cull);
    double distance(Point sample) const;
    bool passes_corner(double y) const;

    /// Calls `use` with each three corners that a driver may have made a triangle of.
    template <class Use>
    void for_triangles_at(Point sample, Use use) const;

    bool empty_ = false;
    bool exact_ = false; ///< By edges_; else by the outline and its band.
    bool walks_ = false; ///< Along its edges, row by row.
    bool clipped_ = false;
    bool flat_ = true;
    std::array<double, 4> flat_color_{};
    std::array<double, 2> depth_bounds_{0.0, 1.0};
    std::array<Edge, 3> edges_{};
    std::vector<Corner> corners_; ///< Of the clipped polygon, counterclockwise.
    double band_ = 0.0;           ///< Half the width of what is undecided, in pixels.
};

} // namespace kb::reference
