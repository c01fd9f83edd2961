// SPDX-License-Identifier: MIT

#include "lib/io/mesh.hpp"
#include "lib/scene/unit_sphere.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace kb
{

static bool is_finite(glm::vec3 v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status check_mesh(const Mesh &mesh)
{
    if (mesh.indices.empty() || mesh.positions.empty())
        return Error{"the mesh has no triangles"};
    if (mesh.indices.size() % 3 != 0)
        return Error{"the mesh's last triangle is cut off"};
    if (mesh.normals.size() != mesh.positions.size() ||
        (!mesh.colors.empty() && mesh.colors.size() != mesh.positions.size()))
        return Error{"the mesh has not one normal and one color for each vertex"};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (!is_finite(mesh.positions[i]))
            return Error{fmt::format("vertex {} of the mesh is not finite", i)};
        if (!is_finite(mesh.normals[i]))
            return Error{fmt::format("normal {} of the mesh is not finite", i)};
    }
    const auto farthest = std::max_element(mesh.indices.begin(), mesh.indices.end());
    if (*farthest >= mesh.positions.size())
        return Error{fmt::format("index {} of the mesh is {}, but it has {} vertices",
                                 farthest - mesh.indices.begin(), *farthest,
                                 mesh.positions.size())};
    return ok;
}

/// All of a vertex, to find it again.
using VertexKey = std::array<std::uint32_t, 10>;

struct VertexKeyHash {
    std::size_t operator()(const VertexKey &key) const
    {
        std::uint64_t hash = 0;
        for (const std::uint32_t word : key)
            hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
        return static_cast<std::size_t>(hash ^ hash >> 32U);
    }
};

static VertexKey vertex_key(const Mesh &mesh, std::size_t i)
{
    const glm::vec3 &p = mesh.positions[i];
    const glm::vec3 &n = mesh.normals[i];
    const glm::vec4 c = mesh.colors.empty() ? glm::vec4(0.0F) : mesh.colors[i];
    return std::bit_cast<VertexKey>(
        std::array<float, 10>{p.x, p.y, p.z, n.x, n.y, n.z, c.r, c.g, c.b, c.a});
}

void join_identical_vertices(Mesh &mesh)
{
    std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> known;
    known.reserve(mesh.positions.size());
    std::vector<std::uint32_t> new_index(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const auto next = static_cast<std::uint32_t>(known.size());
        const auto [place, is_new] = known.try_emplace(vertex_key(mesh, i), next);
        new_index[i] = place->second;
        if (is_new) {
            mesh.positions[next] = mesh.positions[i];
            mesh.normals[next] = mesh.normals[i];
            if (!mesh.colors.empty())
                mesh.colors[next] = mesh.colors[i];
        }
    }
    mesh.positions.resize(known.size());
    mesh.normals.resize(known.size());
    if (!mesh.colors.empty())
        mesh.colors.resize(known.size());
    for (std::uint32_t &index : mesh.indices)
        index = new_index[index];
}

void fit_to_unit_sphere(Mesh &mesh)
{
    fit_to_unit_sphere(std::span(mesh.positions));
}

/// A hue of full saturation, for a turn of 0 to 1.
static glm::vec3 hue(float turn)
{
    const auto channel = [turn](float shift) {
        return 0.55F + 0.45F * std::cos(glm::two_pi<float>() * (turn + shift));
    };
    return {channel(0.0F), channel(1.0F / 3.0F), channel(2.0F / 3.0F)};
}

/// A grid of (columns + 1) x (rows + 1) vertices, already appended from `first` on, row by row.
static void append_grid_indices(Mesh &mesh, std::uint32_t first, int columns, int rows)
{
    const auto stride = static_cast<std::uint32_t>(columns + 1);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const std::uint32_t a = first + static_cast<std::uint32_t>(row) * stride +
                                    static_cast<std::uint32_t>(column);
            const std::uint32_t c = a + stride;
            mesh.indices.insert(mesh.indices.end(), {a, a + 1, c, c, a + 1, c + 1});
        }
    }
}

/// A closed tube of the given radius along a trefoil knot.
static void append_knot(Mesh &mesh, float tube_radius, float hue_shift, float alpha, int along,
                        int around)
{
    constexpr float tau = glm::two_pi<float>();
    const auto way = [](float t) {
        return glm::vec3(std::sin(tau * t) + 2.0F * std::sin(2.0F * tau * t),
                         std::cos(tau * t) - 2.0F * std::cos(2.0F * tau * t),
                         -1.4F * std::sin(3.0F * tau * t));
    };

    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i <= along; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(along);
        const glm::vec3 tangent = glm::normalize(way(t + 1e-3F) - way(t - 1e-3F));
        const glm::vec3 side = glm::normalize(glm::cross(tangent, glm::vec3(0.0F, 0.0F, 1.0F)));
        const glm::vec3 up = glm::cross(tangent, side);
        for (int j = 0; j <= around; ++j) {
            const float angle = tau * static_cast<float>(j) / static_cast<float>(around);
            const glm::vec3 normal = std::cos(angle) * side + std::sin(angle) * up;
            mesh.positions.push_back(way(t) + tube_radius * normal);
            mesh.normals.push_back(normal);
            mesh.colors.emplace_back(hue(2.0F * t + hue_shift), alpha);
        }
    }
    append_grid_indices(mesh, first, around, along);
}

Mesh make_knot(std::size_t triangles)
{
    // Both tubes have half of the triangles; the way is some 12 times as long as a tube is round.
    const double quads = static_cast<double>(triangles) / 4.0;
    const int around = std::max(3, static_cast<int>(std::sqrt(quads / 12.0)));
    const int along = std::max(8, static_cast<int>(quads / around));
    Mesh mesh;
    // Eight bits hold these alphas exactly.
    append_knot(mesh, 0.6F, 0.0F, 76.0F / 255.0F, along, around);
    append_knot(mesh, 0.25F, 0.5F, 178.0F / 255.0F, along, around);
    fit_to_unit_sphere(mesh);
    return mesh;
}

void append_sphere(Mesh &mesh, glm::vec3 center, float radius, glm::vec4 color, int slices,
                   int stacks)
{
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i <= stacks; ++i) {
        const float polar = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(stacks);
        for (int j = 0; j <= slices; ++j) {
            const float turn =
                glm::two_pi<float>() * static_cast<float>(j) / static_cast<float>(slices);
            const glm::vec3 normal(std::sin(polar) * std::cos(turn), std::cos(polar),
                                   std::sin(polar) * std::sin(turn));
            mesh.positions.push_back(center + radius * normal);
            mesh.normals.push_back(normal);
            mesh.colors.push_back(color);
        }
    }
    append_grid_indices(mesh, first, slices, stacks);
}

void append_quad(Mesh &mesh, glm::vec3 corner, glm::vec3 u, glm::vec3 v, glm::vec4 color)
{
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::vec3 normal = glm::normalize(glm::cross(u, v));
    for (const glm::vec3 &p : {corner, corner + u, corner + v, corner + u + v}) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(normal);
        mesh.colors.push_back(color);
    }
    append_grid_indices(mesh, first, 1, 1);
}

} // namespace kb
