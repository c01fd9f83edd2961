// SPDX-License-Identifier: MIT
//
// What a scalar looks like: color and extinction, piecewise linear between control points. The
// medium emits extinction * color, so that a ray sees
//
//     I = integral of extinction(s(x)) color(s(x)) exp(-optical depth from the eye to x) dx
//
// Extinction is per unit of length in a grid whose bounding sphere has radius 1.

#pragma once

#include "lib/result.hpp"
#include "volume/scalar_range.hpp"

#include <glm/vec3.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kb
{

struct TransferPoint {
    float value = 0.0F; ///< Of the scalar.
    glm::vec3 color{0.0F};
    float extinction = 0.0F; ///< From 0 to infinity.
};

class TransferFunction
{
public:
    /// At least one point, values ascending and finite, colors from 0 to 1. Where two points have
    /// the same value the function steps. Outside the points it is as at the first and the last.
    /// Errors tell values with the offset added.
    static Result<TransferFunction> make(std::vector<TransferPoint> points, double offset = 0.0);

    TransferPoint at(float value) const;

    std::span<const TransferPoint> points() const { return points_; }

    /// The same function of (value - low) / (high - low).
    TransferFunction normalized(float low, float high) const;

private:
    explicit TransferFunction(std::vector<TransferPoint> points) : points_(std::move(points)) {}

    std::vector<TransferPoint> points_;
};

/// Text, one point a line: value red green blue extinction; # begins a comment. A line `normalized`
/// before the first point says that values are from 0 to 1 over the field's range; without it they
/// are the field's. The result is normalized in any case.
Result<TransferFunction> parse_transfer_function(std::string_view text, ScalarRange range);
Result<TransferFunction> load_transfer_function(const std::filesystem::path &path,
                                                ScalarRange range);

/// The built-in ones, normalized, by name: "haze" (everything, thin) and "shells" (a few values,
/// dense).
Result<TransferFunction> find_transfer_function(std::string_view name);
std::span<const std::string_view> transfer_function_names();

} // namespace kb
