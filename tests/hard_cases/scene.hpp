// SPDX-License-Identifier: MIT
//
// What the cases draw. The color of a vertex is (value, alpha, id, 1): layers keep these numbers as
// they are, and whoever composites them takes the value as the color.

#pragma once

#include "lib/gl/gl_objects.hpp"
#include "lib/gl/mesh_buffers.hpp"
#include "lib/scene/camera.hpp"

#include <glm/mat4x4.hpp>

#include <array>
#include <cstdint>
#include <random>
#include <string>

namespace kb::hard
{

/// More than one tile of llvmpipe (64x64 pixels), and no multiple of its 4x4 blocks' columns.
inline constexpr Size usual_size{74, 52};

struct Attributes {
    double value = 1.0;
    double alpha = 0.5;
    int id = 0;
};

struct Scene {
    Mesh mesh{};
    glm::mat4 projection{1.0F};
    /// Statements that may change `color` and gl_FragDepth.
    std::string fragment_statements{};
    std::string fragment_declarations{};
};

/// A triangle of the scene's coordinates.
void append_triangle(Mesh &mesh, const std::array<glm::vec3, 3> &corners, Attributes attributes);

/// Two triangles, cut from the first corner to the third.
void append_quad(Mesh &mesh, const std::array<glm::vec3, 4> &corners, Attributes attributes);

/// One triangle over the whole view, at one depth of the window (without a projection).
void append_full(Mesh &mesh, double depth, Attributes attributes);

/// A projection with a near plane at w = 1, a far one at 16 and clip x and y as they are given.
glm::mat4 perspective();

/// The corners of the view, counterclockwise, of a plane that recedes to the left and downwards, to
/// be seen through perspective().
std::array<glm::vec3, 4> receding_plane();

/// Two quads that share a slanted edge through the pixels, the second one `step` behind.
Scene make_abutting_quads(float step);

/// A sphere whose triangles share their vertices: nothing but the surface between them.
Mesh make_closed_sphere(float radius, int slices, int stacks);

template <class T>
void shuffle(std::vector<T> &list, std::uint32_t seed)
{
    // std::shuffle gives another order on other platforms.
    std::mt19937 random(seed);
    for (std::size_t i = list.size(); i > 1; --i)
        std::swap(list[i - 1], list[random() % i]);
}

/// A scene in GL's memory.
class SceneInGl
{
public:
    SceneInGl(const Gl &gl, const Scene &scene);

    /// Draws this mesh from now on: a program of its own would have to be compiled.
    void replace(const Mesh &mesh) { mesh_ = MeshBuffers(gl_, mesh); }

    void draw() const;
    void draw_triangle(std::size_t triangle) const;

private:
    void use() const;

    const Gl &gl_;
    MeshBuffers mesh_;
    glm::mat4 projection_;
    Program program_;
};

} // namespace kb::hard
