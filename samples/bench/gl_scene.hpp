// SPDX-License-Identifier: MIT
//
// A scene in GL buffers, and the programs that all methods draw with.

#pragma once

#include "bench/study_scene.hpp"
#include "lib/gl/mesh_buffers.hpp"

#include <stdexcept>
#include <string>

namespace kb::bench
{

/// The value, or its error as an exception: a worker answers every failure in one place.
template <class T>
T must(Result<T> result)
{
    if (!result)
        throw std::runtime_error(result.error().message);
    return *std::move(result);
}

class GlScene
{
public:
    GlScene(const Gl &gl, const StudyScene &scene)
        : gl_(gl), mesh_(gl, scene.mesh), projection_(scene.projection)
    {
    }

    /// Draws all triangles with a program of make_geometry_program.
    void draw(const Program &program) const;

private:
    const Gl &gl_;
    MeshBuffers mesh_;
    glm::mat4 projection_;
};

/// A program that draws scenes. The methods differ in the fragment shader's main alone, which can
/// call `vec4 shade()` for the color, not premultiplied.
Program make_geometry_program(const Gl &gl, const std::string &extensions,
                              const std::string &fragment_main);

/// A program that draws the full-screen triangle with this fragment shader.
Program make_view_program(const Gl &gl, const std::string &fragment_source);

} // namespace kb::bench
