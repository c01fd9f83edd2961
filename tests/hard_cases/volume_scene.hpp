// SPDX-License-Identifier: MIT
//
// Volumes for the hard cases, drawn by the renderers of samples/volume: the exact one is depth
// peeling with continuation, the other one a k-buffer program.

#pragma once

#include "tests/hard_cases/method.hpp"

#include "lib/io/image.hpp"
#include "volume/faces.hpp"
#include "volume/transfer_function.hpp"
#include "volume/volume_renderer.hpp"

#include <memory>
#include <span>
#include <vector>

namespace kb::hard
{

/// Where a plane across the view lies, and what the scalar is there.
struct Level {
    double depth; ///< From the plane of the eye.
    float scalar;
};

/// Planes across the view, from the nearest on, between which the scalar is linear: the first is
/// where rays enter, from the last they leave. No planes are cells of their own, so the faces stand
/// for cells of any shape.
FaceMesh make_slabs(std::span<const Level> levels, const OrbitCamera &camera);

/// `count` planes at equal distances, scalars from `first` to `last`.
std::vector<Level> make_levels(int count, double front, double back, float first = 0.0F,
                               float last = 1.0F);

/// The same extinction at all scalars, and colors from one to the other.
TransferFunction make_uniform_transfer(float extinction, glm::vec3 at_0, glm::vec3 at_1);

/// How volumes are drawn: in front of black unless there is another background.
struct VolumeLook {
    TransferFunction transfer;
    OrbitCamera camera{};
    glm::vec3 background{0.0F};
};

/// Draws by the renderer that stands for a method.
class VolumeDrawer
{
public:
    VolumeDrawer(const Gl &gl, Method &method, const Shape &shape, const VolumeLook &look);

    /// Top row first. The method's flaw is that a face is lost, of the first mesh.
    ImageRgbaF draw(const FaceMesh &mesh);

private:
    const Gl &gl_;
    Method &method_;
    Size size_;
    OrbitCamera camera_;
    std::unique_ptr<VolumeRenderer> renderer_;
};

} // namespace kb::hard
