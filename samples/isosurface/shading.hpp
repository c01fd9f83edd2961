// SPDX-License-Identifier: MIT
//
// Light for surfaces of which nothing but the depth is known.
//
// With X, Y the slopes of a pixel's ray and u = 1 / depth, a plane n . p = c is seen as
//
//     u = (X n.x + Y n.y - n.z) / c
//
// which is linear over the picture. So central differences of u give the normal of a plane exactly,
//
//     n ~ (-du/dX, -du/dY, u - X du/dX - Y du/dY)
//
// and its second differences are 0 on a plane however it is tilted: they show where the depth
// jumps. Pixels without a surface are infinitely far away, u = 0, and so make silhouettes, too.

#pragma once

#include "lib/gl/gl_objects.hpp"
#include "lib/gl/kbuffer.hpp"
#include "lib/scene/camera.hpp"

#include <glm/vec3.hpp>

#include <array>

namespace kb
{

struct ShadingSettings {
    Size size;
    glm::vec3 background{1.0F};
    bool silhouettes = true;
    /// A pixel this much nearer to the eye than the mean of two opposite neighbours is on a
    /// silhouette.
    float depth_step = 0.03F;
    /// Depths are made smooth over this many pixels to each side, but not across such a step.
    int smoothing = 0;
};

/// Where the surfaces are to be found.
struct CapturedSurfaces {
    const KBuffer &kbuffer;
    int entry; ///< x = 1 / distance from the eye, 0 for none; y = iso-value.
    /// The colors, in the second of two rows: of a value at ((value - base) * scale + offset, 3/4).
    const Texture &table;
    float base, scale, offset;
};

class ShadingPass
{
public:
    static Result<ShadingPass> make(const Gl &gl, const ShadingSettings &settings);

    /// Draws all pixels into color attachment 0 of the framebuffer.
    void draw(const CapturedSurfaces &surfaces, const OrbitCamera &camera,
              GLuint framebuffer) const;

private:
    struct Programs {
        Program gather;
        Program smooth;
        Program shade;
    };
    ShadingPass(const Gl &gl, const ShadingSettings &settings, Programs programs);

    ShadingSettings settings_;
    Programs programs_;
    VertexArray empty_;
    std::array<Texture, 2> surfaces_; ///< 1 / depth and iso-value of each pixel; two to smooth.
    std::array<Framebuffer, 2> framebuffers_;
};

} // namespace kb
