// SPDX-License-Identifier: MIT

#include "tests/hard_cases/box_chords.hpp"

#include <algorithm>
#include <cmath>

namespace kb::hard
{

BoxChords::BoxChords(const TetGrid &box, const OrbitCamera &camera, Size size)
    : view_(integrator::make_view(camera, size)),
      eye_distance_(static_cast<double>(camera.distance))
{
    for (const glm::vec3 &point : box.points)
        half_side_ = std::max(half_side_, static_cast<double>(point.x));
}

double BoxChords::volume() const
{
    return std::pow(2.0 * half_side_, 3);
}

Chord BoxChords::at(int x, int y) const
{
    const double snap = 1.0 / 256.0;
    const glm::dvec2 center(x + 0.5, y + 0.5);
    const auto [in, out] = cross(center);
    Chord chord{};
    chord.least = chord.greatest = chord.middle = length(center);
    // The integral of w^2 from in to out is (out - in) times this; without a chord, about.
    const double square =
        chord.middle > 0.0 ? (in * in + in * out + out * out) / 3.0 : eye_distance_ * eye_distance_;
    chord.volume_factor = view_.pixel_area() * square / per_depth(center);
    for (const glm::dvec2 corner : {glm::dvec2(-snap, -snap), glm::dvec2(snap, -snap),
                                    glm::dvec2(-snap, snap), glm::dvec2(snap, snap)}) {
        chord.least = std::min(chord.least, length(center + corner));
        chord.greatest = std::max(chord.greatest, length(center + corner));
    }
    return chord;
}

integrator::Interval BoxChords::cross(glm::dvec2 place) const
{
    return cross_box(view_, view_.device_coordinates(place), half_side_);
}

double BoxChords::per_depth(glm::dvec2 place) const
{
    return view_.length_per_depth(view_.device_coordinates(place));
}

} // namespace kb::hard
