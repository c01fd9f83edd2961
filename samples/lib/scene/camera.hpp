// SPDX-License-Identifier: MIT

#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace kb
{

struct Size {
    int width = 512;
    int height = 512;
};

/// A perspective camera that turns about the origin. Meshes are fitted to the unit sphere, which
/// the initial distance makes fill the view.
struct OrbitCamera {
    float azimuth = 0.0F;   ///< Degrees about +y.
    float elevation = 0.0F; ///< Degrees above the xz plane.
    float distance = 2.7F;
    float field_of_view = 45.0F; ///< Degrees, of the shorter side of the picture.
    float nearest = 0.01F;       ///< Depth of the near plane at least, wherever the sphere is.

    glm::mat4 view() const;
    glm::mat4 projection(Size size) const;

    void turn(float azimuth_degrees, float elevation_degrees);
    void zoom(float factor);
};

} // namespace kb
