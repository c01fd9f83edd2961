// SPDX-License-Identifier: MIT
//
// The cells that the rays of a picture go through.

#pragma once

#include "lib/scene/camera.hpp"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace kb::integrator
{

/// Tetrahedra that do not overlap, in any orientation, with a scalar at each point.
struct Cells {
    std::span<const glm::vec3> points;
    std::span<const glm::uvec4> cells;
    std::span<const float> scalars;
};

/// A camera with perspective. Depth along a ray is w of clip coordinates: the distance from the
/// plane of the eye.
struct View {
    glm::dmat4 view; ///< Without scaling: lengths are those of the cells' coordinates.
    glm::dmat4 projection;
    Size size;

    /// Depths that are seen: w from `near` on. The far plane cuts nothing off.
    double near = 0.0;

    /// Where a place of the picture in pixels, from its top left corner, lies in clip coordinates
    /// over w.
    glm::dvec2 device_coordinates(glm::dvec2 place) const;

    /// The length of a ray for each 1 of w.
    double length_per_depth(glm::dvec2 device) const;

    /// The area of a pixel at w = 1.
    double pixel_area() const;
};

/// The camera's own matrices, which samples give to GL, as doubles.
View make_view(const OrbitCamera &camera, Size size);

/// The part of a ray in one cell.
struct RaySegment {
    double front; ///< w
    double back;
    double scalar_front;
    double scalar_back;
    std::uint32_t cell;
};

/// The segments of each pixel of a number of rows, from front to back. Where two cells share a face
/// the end of one segment is the front of the next one, bit for bit.
class RaySegments
{
public:
    /// The points in clip coordinates are found once. `offset` moves all rays, in pixels.
    RaySegments(const Cells &cells, const View &view, glm::dvec2 offset = {0.0, 0.0});

    /// Rows from the top one: [pixel] from the left, row by row.
    std::vector<std::vector<RaySegment>> find(int first_row, int row_count) const;

    /// Where the ray of a pixel goes through.
    glm::dvec2 device_coordinates(int x, int y) const;

private:
    struct Box { ///< Of pixels, the last ones included.
        int left, right, top, bottom;
    };
    Box pixels_about(const glm::uvec4 &cell) const;

    Cells cells_;
    View view_;
    glm::dvec2 offset_;
    std::vector<glm::dvec4> clip_;
};

} // namespace kb::integrator
