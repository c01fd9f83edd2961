// SPDX-License-Identifier: MIT
//
// The k-buffer program on streams of fragments that are given one by one, the same in all pixels.

#include "tests/isosurface/isosurface_test.hpp"

#include "lib/gl/mesh_buffers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kb::test
{

namespace
{

/// A fragment with a tag as faces of a grid's boundary have it, or with none.
struct Fragment {
    float distance;
    float tagged_scalar;
};

constexpr float enter = SortedFaces::boundary_tag;

class GivenStream final : public FragmentStream
{
public:
    GivenStream(const Gl &gl, Medium medium, std::vector<Fragment> fragments, Program program)
        : empty_(gl), medium_(medium), fragments_(std::move(fragments)),
          program_(std::move(program))
    {
    }

    void sort(const OrbitCamera &, Size) override {}

    void draw(const OrbitCamera &, Size) const override
    {
        program_.use();
        for (const Fragment &fragment : fragments_) {
            empty_.gl().Uniform4f(program_.uniform("value"), fragment.distance,
                                  fragment.tagged_scalar, 0.0F, 0.0F);
            draw_full_screen(empty_.gl(), empty_);
        }
    }

    Result<Disorder> capture_disorder(const OrbitCamera &, Size, const GoOn &) const override
    {
        return Error{"it draws one fragment by each command"};
    }

    Medium medium() const override { return medium_; }
    std::size_t count() const override { return fragments_.size(); }
    std::string_view primitive() const override { return "fragments"; }

private:
    VertexArray empty_;
    Medium medium_;
    std::vector<Fragment> fragments_;
    Program program_;
};

class ProgramTest : public IsosurfaceTest
{
protected:
    /// Distance and scalar of the surface; 0, 0 if there is none.
    glm::vec2 find(Medium medium, const std::vector<Fragment> &fragments,
                   const std::vector<float> &values, int k = 4, float gap = 1.5F)
    {
        auto program = Program::make(gl(), full_screen_vertex_shader,
                                     "#version 330\nuniform vec4 value;\n"
                                     "layout(location = 0) out vec4 fragment;\n"
                                     "void main() { fragment = value; }\n");
        EXPECT_TRUE(program) << program.error().message;
        Result<std::unique_ptr<FragmentStream>> stream = std::unique_ptr<FragmentStream>(
            std::make_unique<GivenStream>(gl(), medium, fragments, std::move(*program)));
        const ImageRgbaF drawn = draw_stream(stream, {0.0F, 1.0F}, values, k, gap);
        for (const glm::vec4 &pixel : drawn.pixels)
            EXPECT_EQ(pixel, drawn.pixels.front()) << "all pixels are the same";
        return drawn.pixels.front();
    }

    static void expect_at(glm::vec2 surface, double distance, float value)
    {
        // Distances are less than 8, rounded some 8 times by 2^-22.
        EXPECT_NEAR(surface.x, distance, 8.0 * std::ldexp(1.0, -22));
        EXPECT_EQ(surface.y, value);
    }
};

TEST_F(ProgramTest, FindsTheFirstIsoValueOnTheWay)
{
    const std::vector<float> values{0.9F, 0.1F, 0.6F, 0.3F};
    // The example of the README, up and down.
    const std::vector<Fragment> up{{2.0F, 0.2F + enter}, {3.0F, 0.7F - enter}};
    const std::vector<Fragment> down{{2.0F, 0.7F + enter}, {3.0F, 0.2F - enter}};
    for (const int k : {1, 2, 3, 4, 9}) {
        SCOPED_TRACE(k);
        expect_at(find(Medium::grid, up, values, k), 2.2, 0.3F);
        expect_at(find(Medium::grid, down, values, k), 2.2, 0.6F);
    }
}

TEST_F(ProgramTest, FindsIsoValuesAtTheEndsOfASegment)
{
    const std::vector<Fragment> fragments{{2.0F, 0.25F + enter}, {3.0F, 0.75F - enter}};
    expect_at(find(Medium::grid, fragments, {0.25F}), 2.0, 0.25F);
    expect_at(find(Medium::grid, fragments, {0.75F}), 3.0, 0.75F);
    EXPECT_EQ(find(Medium::grid, fragments, {0.2F, 0.8F}), glm::vec2(0.0F));
    // Both ends have the value.
    const std::vector<Fragment> flat{{2.0F, 0.25F + enter}, {3.0F, 0.25F}, {4.0F, 0.5F - enter}};
    expect_at(find(Medium::grid, flat, {0.25F}), 2.0, 0.25F);
    // Segments of no length have it at their place.
    const std::vector<Fragment> step{{2.0F, 0.1F + enter}, {2.0F, 0.9F}, {3.0F, 1.0F - enter}};
    expect_at(find(Medium::grid, step, {0.5F}), 2.0, 0.5F);
}

TEST_F(ProgramTest, PutsFragmentsInOrder)
{
    // No fragment is more than three places from where it belongs.
    const std::vector<Fragment> fragments{{3.0F, 0.3F},         {2.0F, 0.2F}, {1.0F, 0.1F + enter},
                                          {6.0F, 0.6F - enter}, {4.0F, 0.4F}, {5.0F, 0.5F}};
    for (const int k : {3, 4, 7}) {
        SCOPED_TRACE(k);
        for (const auto &[value, distance] :
             {std::pair(0.125F, 1.25), {0.25F, 2.5}, {0.375F, 3.75}, {0.55F, 5.5}})
            expect_at(find(Medium::grid, fragments, {value}, k), distance, value);
    }
}

TEST_F(ProgramTest, FindsNothingOutOfTheGrid)
{
    // The iso-value is between two grids, and in front of the first one, where all is cleared to 0.
    const std::vector<Fragment> fragments{
        {2.0F, 0.6F + enter}, {3.0F, 0.7F - enter}, {4.0F, 0.3F + enter}, {5.0F, 0.4F - enter}};
    EXPECT_EQ(find(Medium::grid, fragments, {0.5F}), glm::vec2(0.0F));
    EXPECT_EQ(find(Medium::particles, {{2.0F, 0.6F}, {3.0F, 0.7F}}, {0.5F}, 4, 10.0F),
              glm::vec2(0.0F));
    // In two grids that overlap a ray is in a grid up to the end of the farther one.
    const std::vector<Fragment> overlapping{
        {2.0F, 0.9F + enter}, {3.0F, 0.8F + enter}, {4.0F, 0.7F - enter}, {5.0F, 0.4F - enter}};
    expect_at(find(Medium::grid, overlapping, {0.55F}), 4.5, 0.55F);
}

TEST_F(ProgramTest, FindsNothingBetweenParticlesFarApart)
{
    const std::vector<Fragment> fragments{{2.0F, 0.25F}, {3.0F, 0.75F}};
    expect_at(find(Medium::particles, fragments, {0.5F}, 4, 1.01F), 2.5, 0.5F);
    EXPECT_EQ(find(Medium::particles, fragments, {0.5F}, 4, 0.99F), glm::vec2(0.0F));
}

TEST_F(ProgramTest, KeepsTheNearestSurfaceWhenFragmentsComeTooLate)
{
    // With k = 1 these leave as 3, 2, 2.4: between 3 and 2 the surface is at 2.5. Between 3, still
    // the front, and 2.4 it would be at 2.7: the depth test refuses that.
    const std::vector<Fragment> fragments{{3.0F, 0.0F}, {4.0F, 1.0F}, {2.0F, 1.0F}, {2.4F, 1.0F}};
    expect_at(find(Medium::particles, fragments, {0.5F}, 1), 2.5, 0.5F);
}

TEST_F(ProgramTest, TakesThousandsOfIsoValues)
{
    const std::vector<Fragment> fragments{{2.0F, 0.0F + enter}, {3.0F, 1.0F - enter}};
    std::vector<float> values;
    for (int i = 4000; i > 0; --i) {
        values.push_back(static_cast<float>(i) / 4000.0F);
        if (i % 1000 == 1)
            expect_at(find(Medium::grid, fragments, values), 2.0 + double(values.back()),
                      values.back());
    }
}

} // namespace

} // namespace kb::test
