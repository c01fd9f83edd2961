// SPDX-License-Identifier: MIT

#include "volume/preintegration.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <thread>

namespace kb
{

double fade(double depth)
{
    // Where the others nearly cancel; the next term is depth^3 / 360.
    if (depth < 1e-3)
        return depth / 6.0;
    return 1.0 + 2.0 / std::expm1(depth) - 2.0 / depth;
}

/// From the place of the largest difference to 1.
static double place_scale(TableSize size)
{
    return (size.most_difference + PreintegratedTable::half_difference) / size.most_difference;
}

TablePlace::TablePlace(TableSize size)
    : sum_scale(0.5 * (size.means - 1)), sum_offset(0.5),
      difference_scale(0.5 * (size.differences - 1) * place_scale(size)),
      difference_offset(0.5 * size.differences)
{
}

namespace
{

/// A part of a segment along which extinction and color are nearly linear.
struct Step {
    double share;        ///< Of the segment's length.
    double depth;        ///< Optical depth of the part, for a segment of length 1.
    glm::dvec3 color;    ///< Mean color, weighted by extinction.
    glm::dvec3 gradient; ///< Half of the color at its front end less that at its back end.
};

/// Between control points extinction and color are linear, so that the optical depth of a part is
/// that by the trapezoidal rule, and Simpson's rule gives its mean color: both exact. What a step
/// neglects is that within it extinction changes while it hides the far end.
class Steps
{
public:
    Steps(const TransferFunction &transfer, double front, double back) : transfer_(transfer)
    {
        // Of the function as it is from 0 to 1; its first and last piece go on beyond.
        const double low = std::max(std::min(front, back), 0.0);
        const double high = std::min(std::max(front, back), 1.0);
        std::vector<double> ends{front};
        for (const TransferPoint &point : transfer.points()) {
            if (point.value > low && point.value < high && point.value != ends.back())
                ends.push_back(point.value);
        }
        if (back < front)
            std::reverse(ends.begin() + 1, ends.end());
        ends.push_back(back);
        for (std::size_t i = 1; i < ends.size(); ++i)
            add_piece(ends[i - 1], ends[i], back - front);
    }

    SegmentOptics at(double length) const
    {
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        double passed = 0.0;
        for (const Step &step : steps_) {
            // Relative to the front, and per unit of length where that is 0.
            const double depth = step.depth * length;
            const double seen = depth > 1e-6 ? -std::expm1(-depth) / depth : 1.0 - depth / 2.0;
            // Where there is no extinction at all, the color that a little of it would have.
            const double weight = std::exp(-passed) * seen * (step.depth + step.share * 1e-30);
            sum += weight * (step.color + fade(depth) * step.gradient);
            weights += weight;
            passed += depth;
        }
        return {glm::vec3(sum / weights), static_cast<float>(depth_)};
    }

private:
    static constexpr int steps_a_piece = 16;

    void add_piece(double from, double to, double extent)
    {
        const double share = extent != 0.0 ? (to - from) / extent : 1.0;
        const auto ends = ends_of_piece(from, to);
        for (int i = 0; i < steps_a_piece; ++i) {
            const auto at = [&](double half_steps) {
                glm::dvec4 value = glm::mix(ends[0], ends[1], half_steps / (2.0 * steps_a_piece));
                value.w = std::max(value.w, 0.0);
                return value;
            };
            const glm::dvec4 a = at(2.0 * i);
            const glm::dvec4 b = at(2.0 * i + 1.0);
            const glm::dvec4 c = at(2.0 * i + 2.0);
            const double extinction = 0.5 * (a.w + c.w);
            const glm::dvec3 emission =
                (glm::dvec3(a) * a.w + 4.0 * glm::dvec3(b) * b.w + glm::dvec3(c) * c.w) / 6.0;
            const double step_share = share / steps_a_piece;
            const double depth = extinction * step_share;
            steps_.push_back({step_share, depth,
                              extinction > 0.0 ? emission / extinction : glm::dvec3(b),
                              0.5 * (glm::dvec3(a) - glm::dvec3(c))});
            depth_ += depth;
        }
    }

    /// Color and extinction at the ends of a piece, extended from its inside: the function may
    /// step at its ends, and they may be beyond 0 or 1.
    std::array<glm::dvec4, 2> ends_of_piece(double from, double to) const
    {
        const double low = std::max(std::min(from, to), 0.0);
        const double high = std::min(std::max(from, to), 1.0);
        const double first = low + 0.25 * (high - low);
        const double second = high - 0.25 * (high - low);
        const glm::dvec4 value = sample(first);
        if (!(second > first))
            return {value, value};
        const glm::dvec4 slope = (sample(second) - value) / (second - first);
        return {value + slope * (from - first), value + slope * (to - first)};
    }

    glm::dvec4 sample(double value) const
    {
        const TransferPoint point = transfer_.at(static_cast<float>(value));
        return glm::dvec4(point.color,
                          std::min(point.extinction, PreintegratedTable::max_extinction));
    }

    const TransferFunction &transfer_;
    std::vector<Step> steps_;
    double depth_ = 0.0;
};

} // namespace

SegmentOptics integrate_segment(const TransferFunction &transfer, float front, float back,
                                float length)
{
    return Steps(transfer, front, back).at(length);
}

SegmentEntry integrate_entry(const TransferFunction &transfer, double mean, double difference)
{
    const Steps steps(transfer, mean - 0.5 * difference, mean + 0.5 * difference);
    const SegmentOptics thin = steps.at(0.0);
    glm::vec3 fading(0.0F);
    if (thin.extinction > 0.0F) {
        constexpr double depth = 2.0;
        const SegmentOptics faded = steps.at(depth / thin.extinction);
        fading = (faded.color - thin.color) / static_cast<float>(fade(depth) * difference);
    }
    return {glm::vec4(thin.color, thin.extinction), glm::vec4(fading, 0.0F)};
}

PreintegratedTable::PreintegratedTable(const TransferFunction &transfer, TableSize size)
    : size_(size),
      thin_(static_cast<std::size_t>(size.means) * static_cast<std::size_t>(size.differences)),
      fading_(thin_.size())
{
    const int parts = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 16);
    std::vector<std::future<void>> work;
    for (int i = 0; i < parts; ++i)
        work.push_back(std::async(std::launch::async, [&, i] {
            fill(transfer, size.differences * i / parts, size.differences * (i + 1) / parts);
        }));
    for (auto &part : work)
        part.get();
}

double PreintegratedTable::difference(TableSize size, int row)
{
    const double place = (2.0 * row / (size.differences - 1) - 1.0) / place_scale(size);
    return half_difference * place / (1.0 - std::abs(place));
}

SegmentEntry PreintegratedTable::entry(const TransferFunction &transfer, TableSize size, int column,
                                       int row)
{
    const double mean = static_cast<double>(column) / (size.means - 1);
    const double least = 1e-3 * size.most_difference; // For the limit of fading.
    const double difference = PreintegratedTable::difference(size, row);
    return integrate_entry(transfer, mean, std::abs(difference) < least ? least : difference);
}

void PreintegratedTable::fill(const TransferFunction &transfer, int first_difference,
                              int last_difference)
{
    for (int j = first_difference; j < last_difference; ++j) {
        for (int i = 0; i < size_.means; ++i) {
            const SegmentEntry entry = PreintegratedTable::entry(transfer, size_, i, j);
            const auto texel = static_cast<std::size_t>(j) * static_cast<std::size_t>(size_.means) +
                               static_cast<std::size_t>(i);
            thin_[texel] = entry.thin;
            fading_[texel] = entry.fading;
        }
    }
}

} // namespace kb
