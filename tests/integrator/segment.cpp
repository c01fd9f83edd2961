// SPDX-License-Identifier: MIT
//
// Within a piece of the transfer function color and extinction are linear. With t from 0 to 1 along
// a part of length l of it, and optical depth A(t), integrating by parts gives
//
//     integral of A' c exp(-A) = c(0) (1 - T) + (c(1) - c(0)) integral of (exp(-A) - T),  T =
//     exp(-A(1))
//
// in which no term is larger than the sum: nothing cancels. What is left to integrate is exp of a
// polynomial of degree 2, which ten Gauss points do on steps of at most 1/2 of optical depth.
//
// Bound: n + 1 points miss at most 64/15 M r^-2n / (1 - r^-2) of the integral over [-1, 1] of a
// function that is at most M on the ellipse with foci -1, 1 and the sum r of its half axes
// (Trefethen, Approximation Theory and Approximation Practice, 19.3). A step is x from 0 to 1 with
// A' <= 1/2 in it and |A''| <= 1/2 (A' does not become negative). For r = 16 the half axis is 8.03,
// so |x - 1/2| <= 4.02 and |A(x) - A(1/2)| <= 4.02 / 2 + 4.02^2 / 4 < 6.1, M < 450 exp(-A(1/2)),
// and for n = 9 the bound is 64/15 * 450 * 16^-18 = 4e-19 of the step: below the rounding of
// doubles.

#include "tests/integrator/segment.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kb::integrator
{

namespace
{

/// Behind this nothing is seen: exp(-64) is 1.6e-28.
constexpr double opaque_depth = 64.0;

/// The points and weights on [-1, 1], of those at positive x.
struct GaussPoint {
    double x;
    double weight;
};
constexpr std::array<GaussPoint, 5> gauss_points{{
    {0.1488743389816312, 0.2955242247147529},
    {0.4333953941292472, 0.2692667193099963},
    {0.6794095682990244, 0.2190863625159821},
    {0.8650633666889845, 0.1494513491505806},
    {0.9739065285171717, 0.0666713443086881},
}};

/// Extinction times length along a part, linear from 0 to 1.
struct Density {
    double front;
    double back;

    double at(double t) const { return front + t * (back - front); }
    double depth(double t) const { return t * (front + 0.5 * t * (back - front)); }
};

/// The next t, behind at most 1/2 of optical depth at the larger density of the step's ends.
double next_step(const Density &density, double t)
{
    const double here = density.at(t);
    const double slope = density.back - density.front;
    if (slope <= 0.0)
        return here * (1.0 - t) <= 0.5 ? 1.0 : t + 0.5 / here;
    // (here + slope h) h = 1/2, without cancellation.
    return std::min(1.0, t + 1.0 / (here + std::sqrt(here * here + 2.0 * slope)));
}

/// The integral of exp(-A(t)) - exp(-A(1)).
double integrate_excess(const Density &density)
{
    double sum = 0.0;
    double t = 0.0;
    while (t < 1.0 && density.depth(t) < opaque_depth) {
        const double end = next_step(density, t);
        const double half = 0.5 * (end - t);
        const double middle = t + half;
        double step = 0.0;
        for (const auto &[x, weight] : gauss_points)
            for (const double at : {middle - half * x, middle + half * x}) {
                const double depth = density.depth(at);
                // A(1) - A(t) = (1 - t) (mean density of the rest): no difference of near numbers.
                const double rest = (1.0 - at) * 0.5 * (density.at(at) + density.back);
                step -= weight * std::exp(-depth) * std::expm1(-rest);
            }
        sum += half * step;
        t = end;
    }
    return sum;
}

/// A part within one piece of the transfer function.
Light integrate_part(const Matter &front, const Matter &back, double length)
{
    if (length == 0.0)
        return {};
    // Infinite extinction at either end: there is infinite optical depth in front of any other
    // place, and the color is that of the front.
    if (std::isinf(front.extinction) || std::isinf(back.extinction))
        return {front.color, std::numeric_limits<double>::infinity()};
    const Density density{front.extinction * length, back.extinction * length};
    const double depth = density.depth(1.0);
    if (depth == 0.0)
        return {};
    return {-std::expm1(-depth) * front.color +
                integrate_excess(density) * (back.color - front.color),
            depth};
}

} // namespace

void Light::append(const Light &behind)
{
    color += std::exp(-optical_depth) * behind.color;
    optical_depth += behind.optical_depth;
}

double Light::alpha() const
{
    return -std::expm1(-optical_depth);
}

Light integrate_segment(const Medium &medium, double scalar_front, double scalar_back,
                        double length)
{
    const auto &pieces = medium.pieces();
    const bool rising = scalar_front <= scalar_back;
    std::size_t i = 0;
    while (i + 1 < pieces.size() && pieces[i].high.value <= scalar_front)
        ++i;
    Light light;
    double scalar = scalar_front;
    for (;;) {
        const Piece &piece = pieces[i];
        const double border = rising ? piece.high.value : piece.low.value;
        const bool last = rising ? scalar_back <= border : scalar_back >= border;
        const double end = last ? scalar_back : border;
        const double share =
            scalar_front == scalar_back ? 1.0 : (end - scalar) / (scalar_back - scalar_front);
        light.append(integrate_part(piece.at(scalar), piece.at(end), share * length));
        if (last)
            return light;
        scalar = end;
        i += rising ? 1U : std::size_t(-1);
    }
}

} // namespace kb::integrator
