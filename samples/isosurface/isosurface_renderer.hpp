// SPDX-License-Identifier: MIT

#pragma once

#include "isosurface/fragment_stream.hpp"
#include "isosurface/iso_values.hpp"
#include "isosurface/shading.hpp"
#include "lib/gl/kbuffer.hpp"

#include <span>

namespace kb
{

struct IsosurfaceSettings {
    int k = 6; ///< Fragments that wait in the k-buffer.
    Medium medium = Medium::grid;
    float gap = 0.1F; ///< Particles farther apart along a ray have nothing between them.
    ShadingSettings shading;
};

/// Draws the nearest of the surfaces of any number of iso-values in one pass over a stream.
class IsosurfaceRenderer
{
public:
    static Result<IsosurfaceRenderer> make(const Gl &gl, const IsosurfaceSettings &settings);

    /// Replaces the iso-values, which are normalized. Nothing but a texture and four numbers
    /// change.
    Status set_iso_values(std::span<const IsoValue> values);

    /// Finds the surfaces of a stream that is sorted for this camera.
    void capture(const FragmentStream &stream, const OrbitCamera &camera);

    /// Shades them into a picture: color attachment 0 of framebuffer().
    void shade(const OrbitCamera &camera);

    GLuint framebuffer() const { return framebuffer_.id(); }

    /// x = distance from the eye along the ray, y = the scalar of its iso-value; both 0 where there
    /// is no surface.
    ImageRgbaF read_surfaces() const;

    int bytes_per_pixel() const;

private:
    IsosurfaceRenderer(const Gl &gl, const IsosurfaceSettings &settings, KBuffer kbuffer,
                       ArbProgram program, Program flush, ShadingPass shading);
    void flush();

    const Gl *gl_;
    IsosurfaceSettings settings_;
    KBuffer kbuffer_;
    ArbProgram program_;
    Program flush_;
    ShadingPass shading_;
    IsoTable table_;
    Texture table_texture_;
    VertexArray empty_;
    Texture picture_;
    Framebuffer framebuffer_;
};

} // namespace kb
