// SPDX-License-Identifier: MIT

#include "lib/io/file.hpp"
#include "lib/io/mesh.hpp"
#include "lib/io/mesh_file.hpp"
#include "lib/io/smooth_normals.hpp"
#include "lib/io/text_fields.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace kb
{

static Result<FileMesh> read_mesh(const std::filesystem::path &path)
{
    const auto content = read_file(path);
    if (!content)
        return content.error();
    if (trim(*content).empty())
        return Error{"it is empty"};
    const std::string ending = to_lower(path.extension().string());
    if (ending == ".ply")
        return read_ply(*content);
    if (ending == ".stl")
        return read_stl(*content);
    if (ending == ".obj")
        return read_obj(*content, path.parent_path());
    if (ending == ".gltf" || ending == ".glb")
        return read_gltf(*content, path.parent_path());
    return Error{"its name ends in none of .obj, .ply, .stl, .gltf and .glb"};
}

static bool is_finite(const glm::dvec3 &v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Forgets vertices that no triangle has: where they are, and what, is nobody's concern.
static Status keep_used_vertices(FileMesh &mesh)
{
    constexpr auto unused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> new_index(mesh.positions.size(), unused);
    for (const std::uint32_t index : mesh.indices)
        new_index[index] = 0;
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < new_index.size(); ++i) {
        if (new_index[i] == unused)
            continue;
        if (!is_finite(mesh.positions[i]))
            return Error{fmt::format("vertex {} is not finite", i)};
        new_index[i] = next;
        mesh.positions[next] = mesh.positions[i];
        if (!mesh.normals.empty())
            mesh.normals[next] = mesh.normals[i];
        if (!mesh.colors.empty())
            mesh.colors[next] = mesh.colors[i];
        ++next;
    }
    mesh.positions.resize(next);
    mesh.normals.resize(next);
    if (!mesh.colors.empty())
        mesh.colors.resize(next);
    for (std::uint32_t &index : mesh.indices)
        index = new_index[index];
    return ok;
}

/// Colors are from 0 to 1, up to rounding.
static Status check_colors(std::vector<glm::vec4> &colors)
{
    constexpr float slack = 1e-3F;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        for (int c = 0; c < 4; ++c) {
            if (!(colors[i][c] >= -slack && colors[i][c] <= 1.0F + slack))
                return Error{fmt::format("a vertex has the color {}, {}, {}, {}, but colors are "
                                         "from 0 to 1",
                                         colors[i].r, colors[i].g, colors[i].b, colors[i].a)};
        }
        colors[i] = glm::clamp(colors[i], 0.0F, 1.0F);
    }
    return ok;
}

struct Sphere {
    glm::dvec3 center;
    double radius;
};

/// Moves and scales positions so that their sphere is the unit sphere; the sphere that they had.
/// An error if they are all in one place.
static Result<Sphere> fit(std::vector<glm::dvec3> &positions)
{
    glm::dvec3 low = positions[0];
    glm::dvec3 high = positions[0];
    for (const glm::dvec3 &p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 center = 0.5 * low + 0.5 * high;
    // To some size near 1 first, where squares are neither too small nor too large for a double.
    const glm::dvec3 halves = glm::max(high - center, center - low);
    const double half = std::max({halves.x, halves.y, halves.z});
    if (!(half > 0.0))
        return Error{"its vertices are all in one place"};
    double radius = 0.0;
    for (glm::dvec3 &p : positions) {
        p = (p - center) / half;
        radius = std::max(radius, glm::length(p));
    }
    for (glm::dvec3 &p : positions)
        p /= radius;
    return Sphere{center, half * radius};
}

static Result<LoadedMesh> make_mesh(FileMesh &&file)
{
    if (file.indices.empty())
        return Error{"it has no triangles"};
    if (auto kept = keep_used_vertices(file); !kept)
        return kept.error();
    if (auto checked = check_colors(file.colors); !checked)
        return checked.error();
    const auto sphere = fit(file.positions);
    if (!sphere)
        return sphere.error();
    complete_normals(file.positions, file.indices, file.normals);

    Mesh mesh;
    for (const glm::dvec3 &p : file.positions)
        mesh.positions.emplace_back(p);
    mesh.normals = std::move(file.normals);
    mesh.colors = std::move(file.colors);
    mesh.indices = std::move(file.indices);
    if (auto checked = check_mesh(mesh); !checked)
        return checked.error();
    join_identical_vertices(mesh);
    return LoadedMesh{std::move(mesh), std::move(file.format), std::move(file.colors_of),
                      sphere->center,  sphere->radius,         std::move(file.notes)};
}

Result<LoadedMesh> load_mesh(const std::filesystem::path &path)
{
    const auto fail = [&path](const std::string &reason) {
        std::string line = reason.substr(0, reason.find_first_of("\r\n"));
        return Error{fmt::format("cannot read the mesh {}: {}", path.string(), line)};
    };
    try {
        auto file = read_mesh(path);
        if (!file)
            return fail(file.error().message);
        auto mesh = make_mesh(*std::move(file));
        if (!mesh)
            return fail(mesh.error().message);
        return mesh;
    } catch (const std::bad_alloc &) {
        return fail("there is not enough memory for it");
    }
}

} // namespace kb
