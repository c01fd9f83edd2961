// SPDX-License-Identifier: MIT
//
// What every method draws: a mesh, Lambert-shaded by a headlight. All methods use the same vertex
// shader with an invariant position, so that a fragment has the same depth in all of them, bit for
// bit.

#pragma once

#include "lib/gl/mesh_buffers.hpp"
#include "lib/scene/camera.hpp"

#include <optional>
#include <string>

namespace kb
{

/// Of a mesh without colors: a light blue.
inline constexpr glm::vec4 default_color(0.55F, 0.75F, 0.95F, 0.4F);

class Scene
{
public:
    /// `alpha` replaces the alpha of all vertices if there is one. A mesh without colors is drawn
    /// in the default color.
    Scene(const Gl &gl, const Mesh &mesh, std::optional<float> alpha);

    /// A program with this scene's shading. `discard` is GLSL that runs first, in main of the
    /// fragment shader; `declarations` stands before it.
    static Result<Program> make_program(const Gl &gl, const std::string &declarations = "",
                                        const std::string &discard = "");

    /// Draws all triangles in their order; the program must come from make_program.
    void draw(const Program &program, const OrbitCamera &camera, Size size) const;

    /// Draws one triangle.
    void draw_triangle(const Program &program, const OrbitCamera &camera, Size size,
                       std::size_t triangle) const;

    std::size_t triangle_count() const { return buffers_.triangle_count(); }

private:
    void use(const Program &program, const OrbitCamera &camera, Size size) const;

    const Gl *gl_;
    MeshBuffers buffers_;
    std::optional<float> alpha_;
};

} // namespace kb
