// SPDX-License-Identifier: MIT

#pragma once

#include "transfer_function.hpp"

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

/// The integrals over segments by the scalars at their ends and their length. Extinction does not
/// depend on the length, and color hardly: the table is fine in the scalars and coarse in length.
class PreintegratedTable
{
public:
    /// For a normalized transfer function and segments of up to max_length.
    PreintegratedTable(const TransferFunction &transfer, float max_length);

    static constexpr int scalars = 256; ///< Texels, at front and back scalars of 0 to 1.
    static constexpr int lengths = 16;  ///< Slices: their length is max_length (i / 15)^2.

    /// Extinction is at most this, infinite extinction is this: in float, times the shortest
    /// length that is not zero it is opaque still, and times the longest it is finite.
    static constexpr float max_extinction = 1e9F;

    float max_length() const { return max_length_; }

    /// (color, extinction), front scalars first, then back ones, then lengths.
    const std::vector<glm::vec4> &texels() const { return texels_; }

private:
    void fill(const TransferFunction &transfer, int first_back, int last_back);

    float max_length_;
    std::vector<glm::vec4> texels_;
};

/// The integral itself, with steps that are ever so fine: what the table holds.
SegmentOptics integrate_segment(const TransferFunction &transfer, float front, float back,
                                float length);

} // namespace kb
