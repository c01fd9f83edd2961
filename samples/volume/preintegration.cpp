// SPDX-License-Identifier: MIT

#include "preintegration.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <thread>

namespace kb
{

namespace
{

/// A part of a segment that is short enough for its color to come from its middle.
struct Step {
    double share;     ///< Of the segment's length.
    double depth;     ///< Optical depth of the part, for a segment of length 1.
    glm::dvec3 color; ///< Mean color, weighted by extinction.
};

/// Between control points extinction and color are linear, so that the optical depth of a part is
/// that by the trapezoidal rule, and Simpson's rule gives its mean color: both exact. What a step
/// neglects is that the extinction within it hides its far end more than its near one.
class Steps
{
public:
    Steps(const TransferFunction &transfer, double front, double back) : transfer_(transfer)
    {
        double from = front;
        std::array<double, 2> ends{std::min(front, back), std::max(front, back)};
        std::vector<double> inner;
        for (const TransferPoint &point : transfer.points()) {
            if (point.value > ends[0] && point.value < ends[1])
                inner.push_back(point.value);
        }
        if (back < front)
            std::reverse(inner.begin(), inner.end());
        for (const double value : inner) {
            add_piece(from, value, back - front);
            from = value;
        }
        add_piece(from, back, back - front);
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
            sum += weight * step.color;
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
        // The values at the ends, seen from inside of the piece: the function may step there.
        const double middle = 0.5 * (from + to);
        const auto ends = inner_ends(from, to, middle);
        for (int i = 0; i < steps_a_piece; ++i) {
            const auto at = [&](double half_steps) {
                const double part = half_steps / (2.0 * steps_a_piece);
                return glm::mix(ends[0], ends[1], part);
            };
            const glm::dvec4 a = at(2.0 * i);
            const glm::dvec4 b = at(2.0 * i + 1.0);
            const glm::dvec4 c = at(2.0 * i + 2.0);
            const double extinction = 0.5 * (a.w + c.w);
            const glm::dvec3 emission =
                (glm::dvec3(a) * a.w + 4.0 * glm::dvec3(b) * b.w + glm::dvec3(c) * c.w) / 6.0;
            const double step_share = share / steps_a_piece;
            const double depth = extinction * step_share;
            steps_.push_back(
                {step_share, depth, extinction > 0.0 ? emission / extinction : glm::dvec3(b)});
            depth_ += depth;
        }
    }

    /// Color and extinction at the ends of a piece, extended from its middle.
    std::array<glm::dvec4, 2> inner_ends(double from, double to, double middle) const
    {
        const auto sample = [this](double value) {
            const TransferPoint point = transfer_.at(static_cast<float>(value));
            return glm::dvec4(point.color,
                              std::min(point.extinction, PreintegratedTable::max_extinction));
        };
        if (from == to)
            return {sample(from), sample(from)};
        const glm::dvec4 quarter = sample(0.5 * (from + middle));
        const glm::dvec4 three_quarters = sample(0.5 * (middle + to));
        const glm::dvec4 slope = three_quarters - quarter;
        // Rounding must not make extinction negative.
        const glm::dvec4 nothing(0.0);
        return {glm::max(quarter - 0.5 * slope, nothing),
                glm::max(three_quarters + 0.5 * slope, nothing)};
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

PreintegratedTable::PreintegratedTable(const TransferFunction &transfer, float max_length)
    : max_length_(max_length),
      texels_(std::size_t(scalars) * std::size_t(scalars) * std::size_t(lengths))
{
    const int parts = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 16);
    std::vector<std::future<void>> work;
    for (int i = 0; i < parts; ++i)
        work.push_back(std::async(std::launch::async, [&, i] {
            fill(transfer, scalars * i / parts, scalars * (i + 1) / parts);
        }));
    for (auto &part : work)
        part.get();
}

void PreintegratedTable::fill(const TransferFunction &transfer, int first_back, int last_back)
{
    constexpr double last = scalars - 1;
    for (int back = first_back; back < last_back; ++back) {
        for (int front = 0; front < scalars; ++front) {
            const Steps steps(transfer, front / last, back / last);
            for (int i = 0; i < lengths; ++i) {
                const double part = static_cast<double>(i) / (lengths - 1);
                const SegmentOptics optics = steps.at(max_length_ * part * part);
                texels_[(std::size_t(i) * std::size_t(scalars) + std::size_t(back)) *
                            std::size_t(scalars) +
                        std::size_t(front)] = glm::vec4(optics.color, optics.extinction);
            }
        }
    }
}

} // namespace kb
