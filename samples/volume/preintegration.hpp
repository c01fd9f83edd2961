// SPDX-License-Identifier: MIT

#pragma once

#include "volume/transfer_function.hpp"

#include <glm/vec4.hpp>

#include <cstddef>
#include <vector>

namespace kb
{

/// What a ray segment gives along which the scalar goes linearly from `front` to `back`: alpha is
/// 1 - exp(-extinction * length), and what comes out at the front end is color * alpha.
struct SegmentOptics {
    glm::vec3 color{0.0F};   ///< Of the emission, as attenuated on its way to the front end.
    float extinction = 0.0F; ///< Mean over the segment.
};

/// Texels: from a mean of 0 to 1, and from a difference back - front of -most_difference to
/// most_difference. Powers of two and one more have texels at 1/2, 1/4...
struct TableSize {
    int means;
    int differences;
    double most_difference = 1.0;
};

/// From a segment to texels, of which the first has its center at 1/2: of the sum of the scalars at
/// its ends, and of d / (|d| + half_difference).
struct TablePlace {
    explicit TablePlace(TableSize size);

    double sum_scale;
    double sum_offset;
    double difference_scale;
    double difference_offset;
};

/// What the table holds of a segment: (thin color, extinction), and ((thick color - thin color) /
/// difference, 0). See PreintegratedTable.
struct SegmentEntry {
    glm::vec4 thin;
    glm::vec4 fading;
};

/// Of the segment with these scalars in its middle and between its ends. `difference` is not 0.
SegmentEntry integrate_entry(const TransferFunction &transfer, double mean, double difference);

/// The integrals over segments, by the scalars at their ends. What depends on the length does so by
/// the optical depth D = extinction * length alone: where extinction is constant and color goes
/// linearly,
///
///     color = thin color + fade(D) (thick color - thin color)
///
/// with the colors in the limits of no and of infinite optical depth. Of other segments the thick
/// color is the one with which this is right at D = 2, so that what is left is an error where
/// extinction bends within an opaque segment.
///
/// Most segments lie in small cells, so that the scalars at their ends are nearly the same: the
/// table is fine in the mean of the two, and has the most texels where their difference is small.
class PreintegratedTable
{
public:
    /// For a normalized transfer function.
    PreintegratedTable(const TransferFunction &transfer, TableSize size);

    /// A difference d is at d / (|d| + half_difference), which is scaled to be from -1 to 1.
    static constexpr double half_difference = 1.0 / 16.0;

    /// Extinction is at most this, infinite extinction is this: in float, times the shortest
    /// length that is not zero it is opaque still, and times the longest it is finite.
    static constexpr float max_extinction = 1e9F;

    TableSize size() const { return size_; }

    /// Of the scalars, in a row of texels.
    static double difference(TableSize size, int row);

    /// What is in a texel: `column` is that of the mean.
    static SegmentEntry entry(const TransferFunction &transfer, TableSize size, int column,
                              int row);

    /// (thin color, extinction), and ((thick color - thin color) / difference, 0), which is as good
    /// as constant where colors are linear; means first. What no segment can be, as one of its ends
    /// is beyond 0 or 1, is such that interpolation is right beside it.
    const std::vector<glm::vec4> &thin() const { return thin_; }
    const std::vector<glm::vec4> &fading() const { return fading_; }

private:
    void fill(const TransferFunction &transfer, int first_difference, int last_difference);

    TableSize size_;
    std::vector<glm::vec4> thin_;
    std::vector<glm::vec4> fading_;
};

/// coth(D / 2) - 2 / D: from D / 6 to 1.
double fade(double depth);

/// The integral itself, with steps that are ever so fine: what the table holds.
SegmentOptics integrate_segment(const TransferFunction &transfer, float front, float back,
                                float length);

} // namespace kb
