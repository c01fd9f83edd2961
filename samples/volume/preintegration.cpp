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

double fade(double depth)
{
    const auto polynomial = [depth](const std::array<double, 4> &c) {
        return depth * (c[0] + depth * (c[1] + depth * (c[2] + depth * c[3])));
    };
    return polynomial(fade_numerator) / (1.0 + polynomial(fade_denominator));
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

void PreintegratedTable::fill(const TransferFunction &transfer, int first_difference,
                              int last_difference)
{
    for (int j = first_difference; j < last_difference; ++j) {
        const double place = (2.0 * j / (size_.differences - 1) - 1.0) / (1.0 + half_difference);
        const double difference = half_difference * place / (1.0 - std::abs(place));
        for (int i = 0; i < size_.means; ++i) {
            const double mean = static_cast<double>(i) / (size_.means - 1);
            const Steps steps(transfer, mean - 0.5 * difference, mean + 0.5 * difference);
            const SegmentOptics thin = steps.at(0.0);
            glm::vec3 fading(0.0F);
            if (thin.extinction > 0.0F) {
                constexpr double depth = 2.0;
                const SegmentOptics faded = steps.at(depth / thin.extinction);
                const glm::vec3 thick =
                    thin.color + (faded.color - thin.color) / static_cast<float>(fade(depth));
                fading = glm::clamp(thick, 0.0F, 1.0F) - thin.color;
            }
            const auto texel = static_cast<std::size_t>(j) * static_cast<std::size_t>(size_.means) +
                               static_cast<std::size_t>(i);
            thin_[texel] = glm::vec4(thin.color, thin.extinction);
            fading_[texel] = glm::vec4(fading, 0.0F);
        }
    }
}

} // namespace kb
