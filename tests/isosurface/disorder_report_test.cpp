// SPDX-License-Identifier: MIT
//
// What `isosurface` says of the disorder of its fragments. Only on drivers where disorder can be
// measured: see capture_disorder.

#include "tests/isosurface/isosurface_test.hpp"

#include "isosurface/isosurface_disorder.hpp"
#include "isosurface/particles.hpp"
#include "lib/scene/unit_sphere.hpp"

namespace kb::test
{

namespace
{

class DisorderReportTest : public IsosurfaceTest
{
protected:
    DisorderReport measure(const FragmentStream &stream)
    {
        auto report = measure_disorder(gl(), settings_, stream, camera_, iso_values_, picture_);
        EXPECT_TRUE(report) << report.error().message;
        return report ? *report : DisorderReport{};
    }
};

TEST_F(DisorderReportTest, OfAGridSaysWhatATooSmallKDoesToThePicture)
{
    TetGrid grid = make_tet_grid({.cubes = 8, .sliver_share = 0.0F});
    fit_to_unit_sphere(grid.points);
    const ScalarField &field = grid.fields.front();
    const ScalarRange range = range_of(field.values);
    auto stream = make_face_stream(gl(), make_face_mesh(grid, field), range);

    draw_stream(stream, range, {-0.5F, 0.5F}, max_isosurface_k);
    const ImageRgbaF exact = picture_;
    const DisorderReport none = measure(**stream);
    EXPECT_EQ(none.colors->max, 0.0);
    // The least k that it promises to be enough is enough, and the next one is not.
    const int enough = none.fragments.displacement();
    ASSERT_GT(enough, 1);
    draw_stream(stream, range, {-0.5F, 0.5F}, enough);
    EXPECT_TRUE(picture_.pixels == exact.pixels);
    EXPECT_EQ(none.fragments.share_wrong(enough), 0.0);
    EXPECT_GT(none.fragments.share_wrong(enough - 1), 0.0);

    draw_stream(stream, range, {-0.5F, 0.5F}, 1);
    const DisorderReport report = measure(**stream);
    EXPECT_EQ(report.fragments.displacement(), enough) << "which no k changes";
    const auto difference = color_error(picture_, exact, report.fragments.pixels());
    EXPECT_EQ(report.colors->max, difference->max);
    EXPECT_EQ(report.colors->share, difference->share);
    EXPECT_GT(report.colors->share, 0.0);
}

TEST_F(DisorderReportTest, OfParticlesSaysThatTheyComeInOrder)
{
    const PointSet set = make_particles(20'000);
    const float side = 2.0F * mean_spacing(set.points);
    const ScalarRange range{0.0F, 1.0F};
    auto stream = make_particle_stream(gl(), set.points, set.fields.front().values, range, side);
    draw_stream(stream, range, {0.3F}, 2, 0.5F);
    const DisorderReport report = measure(**stream);
    // Depths of neighbours in the order may change places where GL rounds them.
    EXPECT_LE(report.fragments.displacement(), 1);
    EXPECT_GT(report.fragments.deepest(), 32);
    EXPECT_EQ(report.colors->max, 0.0);
}

} // namespace

} // namespace kb::test
