// SPDX-License-Identifier: MIT
//
// One method of the study with its storage: draws whole frames on request.
#pragma once

#include "bench/gl_scene.hpp"
#include "lib/scene/camera.hpp"

#include <memory>
#include <string>

namespace kb::bench
{

class Renderer
{
public:
    virtual ~Renderer() = default;
    Renderer(const Renderer &) = delete;
    Renderer &operator=(const Renderer &) = delete;

    /// Clears, draws the geometry as often as the method needs, and resolves into the framebuffer.
    virtual void draw(const GlScene &scene, GLuint target) = 0;

    /// Number of passes over the geometry.
    virtual int passes() const { return 1; }
    /// Of what the method stores beside the final image, once it has drawn a scene.
    virtual int bytes_per_pixel() const = 0;

protected:
    Renderer() = default;
};

std::unique_ptr<Renderer> make_zbuffer(const Gl &gl, Size size);
std::unique_ptr<Renderer> make_classic_peeling(const Gl &gl, Size size, int k);
/// Depths that differ by no more than `epsilon` are taken for one. The study's method has none.
std::unique_ptr<Renderer> make_dual_peeling(const Gl &gl, Size size, int k, float epsilon = 0.0F);
std::unique_ptr<Renderer> make_fbfetch(const Gl &gl, Size size, int k);
std::unique_ptr<Renderer> make_linked_list(const Gl &gl, Size size, int k);
std::unique_ptr<Renderer> make_k_plus(const Gl &gl, const std::string &variant, Size size, int k);
std::unique_ptr<Renderer> make_kbuffer_program(const Gl &gl, Size size, int k);
std::unique_ptr<Renderer> make_depth_peeling(const Gl &gl, Size size, int k);

/// By the names of method and variant in methods.hpp. A variant that is a setting of the driver
/// makes no difference here.
std::unique_ptr<Renderer> make_renderer(const Gl &gl, const std::string &method,
                                        const std::string &variant, Size size, int k);

} // namespace kb::bench
