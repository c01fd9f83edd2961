// SPDX-License-Identifier: MIT
//
// The rival methods of the study draw exact pictures: what comes of the same fragments, captured by
// a pass of its own, in double precision on the CPU.

#include "bench/capture.hpp"
#include "bench/renderer.hpp"
#include "lib/gl/context.hpp"
#include "lib/gl/kbuffer.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace kb::bench
{

namespace
{

// No multiples of the 4x4 pixels that lie together in storage.
constexpr Size size{61, 47};

// Colors of eight bits a channel are kept as they are. Each of k steps of sum += T alpha rgb,
// T *= 1 - alpha rounds four times values of at most 1 by half of 2^-23; colors are interpolated,
// of equal ones with an error of a few 2^-23, to which a step's sum and T are as sensitive as to
// their own rounding.
double tolerance(int k)
{
    return k * 2.0 * std::ldexp(1.0, -22);
}

glm::vec4 eight_bit_color(std::mt19937 &random)
{
    const auto channel = [&random] { return static_cast<float>(random() % 256) / 255.0F; };
    const float red = channel();
    const float green = channel();
    const float blue = channel();
    return {red, green, blue, static_cast<float>(20 + random() % 100) / 255.0F};
}

/// A triangle that faces the headlight, so that its color is not darkened.
void append_triangle(Mesh &mesh, const std::array<glm::vec3, 3> &corners, glm::vec4 color)
{
    for (const glm::vec3 &corner : corners) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(corner);
        mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
        mesh.colors.push_back(color);
    }
}

/// Triangles of random place that cross each other.
StudyScene make_soup(int triangles)
{
    StudyScene scene;
    std::mt19937 random(2014);
    const auto coordinate = [&random] {
        return static_cast<float>(random() >> 8U) * 0x1.8p-24F - 0.75F;
    };
    for (int i = 0; i < triangles; ++i) {
        std::array<glm::vec3, 3> corners{};
        for (glm::vec3 &corner : corners)
            for (int axis = 0; axis < 3; ++axis)
                corner[axis] = coordinate();
        append_triangle(scene.mesh, corners, eight_bit_color(random));
    }
    return scene;
}

/// Each depth is that of three triangles over the whole view, which lie apart in the order of
/// drawing. They have the same color if `alike`.
StudyScene make_ties(int depths, bool alike)
{
    StudyScene scene;
    std::mt19937 random(1999);
    for (int i = 0; i < 3 * depths; ++i) {
        const int place = i * 7 % depths; // 7 and `depths` have no common divisor.
        const float z = 0.9F - 1.8F * static_cast<float>(place) / static_cast<float>(depths);
        std::mt19937 own(static_cast<std::uint32_t>(place));
        append_triangle(scene.mesh, {{{-1.0F, -1.0F, z}, {3.0F, -1.0F, z}, {-1.0F, 3.0F, z}}},
                        eight_bit_color(alike ? own : random));
    }
    return scene;
}

struct Form {
    const char *method;
    const char *variant;
};

class BenchMethods : public testing::TestWithParam<Form>
{
protected:
    BenchMethods() : context_(must(make_context("osmesa"))) {}

    /// What the method at hand draws.
    ImageRgbaF draw(const GlScene &scene, int k)
    {
        const Gl &gl = context_->gl();
        const Texture color = make_texture_2d(gl, GL_RGBA32F, size.width, size.height);
        const Framebuffer framebuffer(gl);
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.id(), 0);
        gl.Viewport(0, 0, size.width, size.height);
        const auto renderer = make_renderer(gl, GetParam().method, GetParam().variant, size, k);
        // The second frame must not show the first.
        renderer->draw(scene, framebuffer.id());
        renderer->draw(scene, framebuffer.id());
        must(check_gl(gl, "drawing"));
        return read_color(gl, framebuffer.id(), size);
    }

    void expect_exact(const StudyScene &study_scene, std::span<const int> ks)
    {
        const GlScene scene(context_->gl(), study_scene);
        context_->gl().Viewport(0, 0, size.width, size.height);
        const Capture exact = capture_exact_images(context_->gl(), scene, size, ks);
        for (std::size_t i = 0; i < ks.size(); ++i) {
            const auto difference = must(compare(draw(scene, ks[i]), exact.images[i]));
            EXPECT_LE(difference.max, tolerance(ks[i])) << "k " << ks[i];
        }
        // A test of the test: that the last fragment is seen.
        if (ks.size() > 1) {
            EXPECT_GT(must(compare(exact.images[0], exact.images[1])).max, 0.01);
        }
    }

    std::unique_ptr<Context> context_;
};

// Dual depth peeling is in the first group alone: what else it draws is half of the farthest, and
// it cannot tell fragments of equal depth apart. A k+-buffer keeps those, but not their order.
class BenchAll : public BenchMethods
{
};

class BenchNearest : public BenchMethods
{
};

class BenchInOrder : public BenchMethods
{
};

TEST_P(BenchNearest, DrawsTheNearestOfManyFragments)
{
    expect_exact(make_soup(90), std::array{1, 2, 3, 5, 8, 16, 17, 64});
}

TEST_P(BenchAll, DrawsAllOfFewFragments)
{
    expect_exact(make_soup(14), std::array{14});
    expect_exact(make_soup(14), std::array{15});
}

TEST_P(BenchNearest, KeepsAllFragmentsOfEqualDepth)
{
    expect_exact(make_ties(8, true), std::array{2, 3, 4, 8, 17, 24});
}

TEST_P(BenchInOrder, ShowsEqualDepthsInOrderOfArrival)
{
    expect_exact(make_ties(8, false), std::array{2, 3, 4, 8, 17, 24});
}

std::string name_of(const testing::TestParamInfo<Form> &info)
{
    std::string name = fmt::format("{}_{}", info.param.method, info.param.variant);
    std::ranges::replace(name, '-', '_');
    return name;
}

constexpr std::array nearest_forms{Form{"linked-list", ""}, Form{"k-plus", ""},
                                   Form{"k-plus", "no-culling"}, Form{"k-plus", "unlocked"}};

INSTANTIATE_TEST_SUITE_P(Dual, BenchAll, testing::Values(Form{"dual-peeling", ""}), name_of);
INSTANTIATE_TEST_SUITE_P(Rivals, BenchAll, testing::ValuesIn(nearest_forms), name_of);
INSTANTIATE_TEST_SUITE_P(Rivals, BenchNearest, testing::ValuesIn(nearest_forms), name_of);
INSTANTIATE_TEST_SUITE_P(Rivals, BenchInOrder, testing::Values(Form{"linked-list", ""}), name_of);

} // namespace

} // namespace kb::bench
