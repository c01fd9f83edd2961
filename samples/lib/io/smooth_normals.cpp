// SPDX-License-Identifier: MIT

#include "lib/io/smooth_normals.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace kb
{

namespace
{

struct Place {
    glm::dvec3 position;
    bool operator==(const Place &other) const { return position == other.position; }
};

struct PlaceHash {
    std::size_t operator()(const Place &place) const
    {
        std::uint64_t hash = 0;
        for (int i = 0; i < 3; ++i) // 0 and -0 are equal.
            hash = (hash ^ std::bit_cast<std::uint64_t>(place.position[i] + 0.0)) *
                   0x9E3779B97F4A7C15U;
        return static_cast<std::size_t>(hash ^ hash >> 32U);
    }
};

/// What the triangles about a place have together.
struct Surroundings {
    glm::dvec3 sum = glm::dvec3(0.0); ///< Of normals, each as long as twice the area.
    glm::dvec3 largest = glm::dvec3(0.0);
    double area = 0.0;

    void add(const glm::dvec3 &normal)
    {
        const double length = glm::length(normal);
        sum += normal;
        area += length;
        if (length > glm::length(largest))
            largest = normal;
    }

    glm::vec3 normal() const
    {
        // Where triangles turn against each other, as those of both sides of a sheet, one will do.
        const glm::dvec3 v = glm::length(sum) > 1e-9 * area ? sum : largest;
        const double length = glm::length(v);
        // A vertex of triangles without area has no direction: any will do.
        return length > 0.0 ? glm::vec3(v / length) : glm::vec3(0.0F, 0.0F, 1.0F);
    }
};

bool is_missing(const glm::vec3 &normal)
{
    const float square = glm::dot(normal, normal);
    return !std::isfinite(square) || square == 0.0F;
}

} // namespace

void complete_normals(std::span<const glm::dvec3> positions, std::span<const std::uint32_t> indices,
                      std::vector<glm::vec3> &normals)
{
    if (std::none_of(normals.begin(), normals.end(), is_missing))
        return;
    std::unordered_map<Place, Surroundings, PlaceHash> places;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::array<glm::dvec3, 3> corners{positions[indices[i]], positions[indices[i + 1]],
                                                positions[indices[i + 2]]};
        const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        for (const glm::dvec3 &corner : corners)
            places[{corner}].add(normal);
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (is_missing(normals[i]))
            normals[i] = places[{positions[i]}].normal();
    }
}

} // namespace kb
