// SPDX-License-Identifier: MIT

#pragma once

#include "volume/transfer_function.hpp"

#include <vector>

namespace kb
{

/// How far scalars may be off along a ray whose color may be off by a tolerance.
///
/// With scalars r in the place of s, the color that comes to the eye is off by
///
///     integral of T(x) (d(sigma c)(x) - d(sigma)(x) L(x)) dx,   d(f)(x) = f(r(x)) - f(s(x)),
///
/// exactly, where T is the transmittance from the eye to x with s, and L, from 0 to 1, the light
/// that comes to x from behind with r. The bracket is linear in L, so between d(sigma c) and
/// d(sigma (c - 1)). If neither is more than
///
///     tolerance / 2 (1 / 2 + sigma(s(x)))
///
/// the color is off by the tolerance at most: the integral of T is no more than the length of the
/// ray, which is 2 at most in the unit sphere, and the integral of T sigma no more than 1.
class ColorTolerance
{
public:
    /// For a normalized transfer function. Infinite extinction is that of the table of segments.
    ColorTolerance(const TransferFunction &transfer, double tolerance);

    /// Whether any scalars from `low` to `high` may stand for any others of them.
    bool allows(double low, double high) const { return allows(low, high, high - low); }

    /// Whether scalars from `low` to `high` may be off by that much, to either side.
    bool allows_deviation(double low, double high, double deviation) const
    {
        return allows(low - deviation, high + deviation, deviation);
    }

    /// The most that allows_deviation allows, to one part in a million; 1 if that is more than 1.
    double most_deviation(double low, double high) const;

private:
    /// Where the transfer function is linear.
    struct Piece {
        double low;
        double high;
        double extinction_low;
        double extinction_high;
        double slope; ///< What is in the bracket changes by this much at most as the scalar does.

        double extinction(double value) const;
    };

    bool allows(double low, double high, double deviation) const;

    double tolerance_;
    std::vector<Piece> pieces_; ///< From minus infinity to infinity.
};

} // namespace kb
