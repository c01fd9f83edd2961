// SPDX-License-Identifier: MIT

#include "volume/color_tolerance.hpp"

#include "volume/preintegration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kb
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

double extinction_of(const TransferPoint &point)
{
    return std::min(point.extinction, PreintegratedTable::max_extinction);
}

/// The steepest that sigma c and sigma (c - 1) are between two points. Their slopes are linear
/// there, so that they are steepest at one of the ends.
double steepest(const TransferPoint &a, const TransferPoint &b)
{
    const double width = double(b.value) - double(a.value);
    if (!(width > 0.0))
        return infinity;
    const double extinction_slope = (extinction_of(b) - extinction_of(a)) / width;
    double slope = 0.0;
    for (int c = 0; c < 3; ++c) {
        const double color_slope = (double(b.color[c]) - double(a.color[c])) / width;
        for (const TransferPoint &end : {a, b}) {
            const double emission_slope =
                extinction_slope * end.color[c] + extinction_of(end) * color_slope;
            slope = std::max(
                {slope, std::abs(emission_slope), std::abs(emission_slope - extinction_slope)});
        }
    }
    return slope;
}

} // namespace

double ColorTolerance::Piece::extinction(double value) const
{
    if (extinction_low == extinction_high)
        return extinction_low; // As beyond the first and the last point.
    return std::lerp(extinction_low, extinction_high, (value - low) / (high - low));
}

ColorTolerance::ColorTolerance(const TransferFunction &transfer, double tolerance)
    : tolerance_(tolerance)
{
    const auto points = transfer.points();
    const double first = extinction_of(points.front());
    const double last = extinction_of(points.back());
    pieces_.push_back({-infinity, points.front().value, first, first, 0.0});
    for (std::size_t i = 1; i < points.size(); ++i) {
        const TransferPoint &a = points[i - 1];
        const TransferPoint &b = points[i];
        pieces_.push_back({a.value, b.value, extinction_of(a), extinction_of(b), steepest(a, b)});
    }
    pieces_.push_back({points.back().value, infinity, last, last, 0.0});
}

bool ColorTolerance::allows(double low, double high, double deviation) const
{
    double slope = 0.0;
    double extinction = infinity;
    auto piece = std::partition_point(pieces_.begin(), pieces_.end(),
                                      [low](const Piece &p) { return p.high < low; });
    for (; piece != pieces_.end() && piece->low <= high; ++piece) {
        // What is touched only changes nothing, unless it is a step.
        if ((piece->low < high && low < piece->high) || piece->low == piece->high)
            slope = std::max(slope, piece->slope);
        extinction = std::min({extinction, piece->extinction(std::max(low, piece->low)),
                               piece->extinction(std::min(high, piece->high))});
    }
    return deviation * slope <= 0.5 * tolerance_ * (0.5 + extinction);
}

double ColorTolerance::most_deviation(double low, double high) const
{
    if (allows_deviation(low, high, 1.0))
        return 1.0;
    double allowed = 0.0;
    for (double step = 0.5; step > 1e-6; step /= 2.0) {
        if (allows_deviation(low, high, allowed + step))
            allowed += step;
    }
    return allowed;
}

} // namespace kb
