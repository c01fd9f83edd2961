// SPDX-License-Identifier: MIT

#include "lib/scene/camera.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace kb
{

glm::mat4 OrbitCamera::view() const
{
    auto view = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 0.0F, -distance));
    view = glm::rotate(view, glm::radians(elevation), glm::vec3(1.0F, 0.0F, 0.0F));
    return glm::rotate(view, glm::radians(-azimuth), glm::vec3(0.0F, 1.0F, 0.0F));
}

glm::mat4 OrbitCamera::projection(Size size) const
{
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    float tangent = std::tan(glm::radians(field_of_view) / 2.0F);
    if (aspect < 1.0F)
        tangent /= aspect; // The field of view is the narrower side's: here the horizontal one.
    // As tight about the unit sphere as it gets, for the precision of depth.
    const float near_plane = std::max(distance - 1.01F, nearest);
    return glm::perspective(2.0F * std::atan(tangent), aspect, near_plane, distance + 1.01F);
}

void OrbitCamera::turn(float azimuth_degrees, float elevation_degrees)
{
    azimuth = std::remainder(azimuth + azimuth_degrees, 360.0F);
    elevation = std::clamp(elevation + elevation_degrees, -90.0F, 90.0F);
}

void OrbitCamera::zoom(float factor)
{
    distance = std::clamp(distance * factor, 0.2F, 20.0F);
}

} // namespace kb
