// SPDX-License-Identifier: MIT
//
// What tests ask of meshes that were loaded.

#pragma once

#include "lib/io/mesh.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace kb::test
{

using Corners = std::array<glm::dvec3, 3>;

/// The triangles in the units of the file.
inline std::vector<Corners> triangles_of(const LoadedMesh &loaded)
{
    std::vector<Corners> triangles;
    for (std::size_t i = 0; i + 2 < loaded.mesh.indices.size(); i += 3) {
        Corners &corners = triangles.emplace_back();
        for (std::size_t c = 0; c < 3; ++c)
            corners[c] =
                loaded.center +
                loaded.radius * glm::dvec3(loaded.mesh.positions[loaded.mesh.indices[i + c]]);
    }
    return triangles;
}

/// Up to the rounding of floats in the unit sphere.
inline void expect_triangles(const Result<LoadedMesh> &loaded, const std::vector<Corners> &expected)
{
    ASSERT_TRUE(loaded) << loaded.error().message;
    const auto found = triangles_of(*loaded);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_LE(glm::distance(found[i][c], expected[i][c]), loaded->radius * 0x1p-22)
                << "triangle " << i << ", corner " << c << ": " << found[i][c].x << ", "
                << found[i][c].y << ", " << found[i][c].z;
}

/// The colors of all corners of all triangles.
inline std::vector<glm::vec4> corner_colors(const LoadedMesh &loaded)
{
    std::vector<glm::vec4> colors;
    for (const std::uint32_t index : loaded.mesh.indices)
        colors.push_back(loaded.mesh.colors.empty() ? glm::vec4(-1.0F) : loaded.mesh.colors[index]);
    return colors;
}

inline void expect_one_color(const Result<LoadedMesh> &loaded, glm::vec4 color)
{
    ASSERT_TRUE(loaded) << loaded.error().message;
    for (const glm::vec4 &c : corner_colors(*loaded))
        EXPECT_LE(glm::distance(c, color), 1e-6F)
            << c.r << ", " << c.g << ", " << c.b << ", " << c.a;
}

/// Refused in one line that names the file and says why.
inline void expect_refused(const std::filesystem::path &path, const std::string &mention)
{
    SCOPED_TRACE(path.filename().string());
    const auto mesh = load_mesh(path);
    ASSERT_FALSE(mesh);
    const std::string &message = mesh.error().message;
    EXPECT_EQ(message.find("cannot read the mesh " + path.string() + ": "), 0U) << message;
    EXPECT_NE(message.find(mention), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

/// Something of the file is left out, and that is said.
inline void expect_note(const Result<LoadedMesh> &loaded, const std::string &mention)
{
    ASSERT_TRUE(loaded) << loaded.error().message;
    for (const std::string &note : loaded->notes) {
        if (note.find(mention) != std::string::npos)
            return;
    }
    ADD_FAILURE() << "no note says '" << mention << "'";
}

} // namespace kb::test
