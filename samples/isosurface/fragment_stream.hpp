// SPDX-License-Identifier: MIT
//
// What is drawn: primitives that come front to back, with (distance from the eye, scalar) of each
// fragment in the first two components of its color.

#pragma once

#include "isosurface/iso_program.hpp"
#include "lib/app/long_work.hpp"
#include "lib/gl/gl_objects.hpp"
#include "lib/scene/camera.hpp"
#include "volume/disorder.hpp"
#include "volume/sorted_faces.hpp"

#include <memory>
#include <string_view>

namespace kb
{

class FragmentStream
{
public:
    virtual ~FragmentStream() = default;

    /// Puts the primitives in order for a view.
    virtual void sort(const OrbitCamera &camera, Size size) = 0;

    /// Draws all of them into the framebuffer that is bound.
    virtual void draw(const OrbitCamera &camera, Size size) const = 0;

    /// How far from depth order the fragments come, since the last sort, which was for this camera.
    /// An error if `go_on` ends it after a pass.
    virtual Result<Disorder> capture_disorder(const OrbitCamera &camera, Size size,
                                              const GoOn &go_on) const = 0;

    virtual Medium medium() const = 0;
    virtual std::size_t count() const = 0;
    virtual std::string_view primitive() const = 0; ///< "triangles", for messages.
};

/// The faces of a tetrahedral grid. Scalars are from 0 to 1 over the range.
Result<std::unique_ptr<FragmentStream>> make_face_stream(const Gl &gl, const FaceMesh &mesh,
                                                         ScalarRange range,
                                                         FaceOrder order = FaceOrder::centroid);

/// Particles as points: squares of the same size in the scene, which face the eye.
Result<std::unique_ptr<FragmentStream>> make_particle_stream(const Gl &gl,
                                                             std::span<const glm::vec3> points,
                                                             std::span<const float> scalars,
                                                             ScalarRange range, float point_size);

} // namespace kb
