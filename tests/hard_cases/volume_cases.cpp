// SPDX-License-Identifier: MIT
//
// Volumes: small and large optical depths, segments without length, thin cells, pre-integration.

#include "tests/hard_cases/box_chords.hpp"
#include "tests/hard_cases/cases.hpp"
#include "tests/hard_cases/volume_scene.hpp"

#include "bench/gl_scene.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

namespace kb::hard
{

using bench::must;

namespace
{

/// All planes lie within the near and far plane, which are 1.01 from the camera's target.
constexpr OrbitCamera straight{};
constexpr double front = 2.0;
constexpr double back = 3.0;

const TransferFunction white(double extinction)
{
    return make_uniform_transfer(static_cast<float>(extinction), glm::vec3(1.0F), glm::vec3(1.0F));
}

/// The least and the greatest of a number of each pixel: of (x, y, pixel).
template <class Number>
Extremes pixel_extremes(const ImageRgbaF &picture, Number number)
{
    Extremes found{std::numeric_limits<double>::infinity(),
                   -std::numeric_limits<double>::infinity()};
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const double value = number(x, y, picture.at(x, y));
            if (std::isnan(value))
                return {value, value};
            found = {std::min(found.least, value), std::max(found.greatest, value)};
        }
    return found;
}

/// The pixels of which a bit differs, in percent.
double changed_pixels(const ImageRgbaF &a, const ImageRgbaF &b)
{
    std::size_t changed = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        changed += a.pixels[i] == b.pixels[i] ? 0 : 1;
    return 100.0 * static_cast<double>(changed) / static_cast<double>(a.pixels.size());
}

/// The length of a pixel's ray between two planes across the view that are 1 apart.
class RayLengths
{
public:
    RayLengths(const OrbitCamera &camera, Size size) : view_(integrator::make_view(camera, size)) {}

    double operator()(int x, int y) const
    {
        return view_.length_per_depth(view_.device_coordinates({x + 0.5, y + 0.5}));
    }

private:
    integrator::View view_;
};

/// 14. The depth at which a ray enters and leaves is known to 2^-23 relative, some 5e-7 of the
/// length of 1, and the lengths between add up to their difference but for rounding: alpha, up to
/// .34, rounds 4096 times by up to 2^-26. Of segments all alike each adds less than the one before,
/// by its part of what is left of 1, so that errors are of either sign: some 64 * 2^-26 = 1e-6. The
/// promise is 1e-5.
Outcome small_optical_depths(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr int count = 4096;
    constexpr double tolerance = 1e-5;
    const FaceMesh mesh = make_slabs(make_levels(count + 1, front, back), straight);
    const RayLengths length(straight, shape.size);
    Outcome outcome;
    for (const double each : {1e-4, 1e-5}) {
        const double extinction = count * each / (back - front);
        const auto picture = VolumeDrawer(gl, method, shape, {white(extinction)}).draw(mesh);
        // Of the rays about the middle, whose length is that between the planes.
        const double middle = picture.at(shape.size.width / 2, shape.size.height / 2).w;
        const double longer =
            length(shape.size.width / 2, shape.size.height / 2) * (back - front) * extinction;
        outcome.push_back({fmt::format("4096 of {}: alpha of a ray in the middle", each),
                           -std::expm1(-longer), middle, tolerance});
        const auto expected = [&](int x, int y) { return -std::expm1(-length(x, y) * extinction); };
        append_extremes(outcome, fmt::format("4096 of {}: alpha less that of the length", each),
                        0.0,
                        pixel_extremes(picture,
                                       [&](int x, int y, const glm::vec4 &pixel) {
                                           return static_cast<double>(pixel.w) - expected(x, y);
                                       }),
                        tolerance);
        append_extremes(outcome, fmt::format("4096 of {}: color less that of the length", each),
                        0.0,
                        pixel_extremes(picture,
                                       [&](int x, int y, const glm::vec4 &pixel) {
                                           return static_cast<double>(pixel.x) - expected(x, y);
                                       }),
                        tolerance);
    }
    return outcome;
}

/// Planes whose scalars differ, in a medium in which that is seen.
FaceMesh make_varied_slabs(int count)
{
    auto levels = make_levels(count, front, back);
    for (std::size_t i = 0; i < levels.size(); ++i)
        levels[i].scalar =
            static_cast<float>(i * 5 % levels.size()) / static_cast<float>(levels.size());
    return make_slabs(levels, straight);
}

TransferFunction varied_transfer()
{
    return must(TransferFunction::make({{0.0F, {1.0F, 0.2F, 0.1F}, 0.5F},
                                        {0.4F, {0.1F, 0.9F, 0.3F}, 4.0F},
                                        {1.0F, {0.2F, 0.3F, 1.0F}, 1.0F}}));
}

/// The mesh with some of its interior faces several times over.
FaceMesh repeat_faces(const FaceMesh &mesh, std::size_t first, std::size_t count, int times)
{
    FaceMesh repeated = mesh;
    const auto from = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first);
    for (int i = 0; i < times; ++i)
        repeated.triangles.insert(repeated.triangles.begin() +
                                      static_cast<std::ptrdiff_t>(mesh.interior_count),
                                  from, from + static_cast<std::ptrdiff_t>(count));
    repeated.interior_count += count * static_cast<std::size_t>(times);
    return repeated;
}

/// A box of jittered cells, from a unit sphere: slivers whose volume is lost by rounding go.
TetGrid make_box(CubeSplit split)
{
    TetGrid grid = make_tet_grid({.cubes = 3, .split = split, .sliver_share = 0.2F});
    fit_to_unit_sphere(grid);
    repair_tet_grid(grid);
    return grid;
}

/// The scalar "distance" over its greatest value: from 0 to 1.
ScalarField unit_field(const TetGrid &grid)
{
    ScalarField field = *must(find_field(grid, "distance"));
    const float greatest = *std::ranges::max_element(field.values);
    for (float &value : field.values)
        value /= greatest;
    return field;
}

const OrbitCamera oblique{.azimuth = 31.0F, .elevation = 22.0F};

/// 15. A face twice makes a segment without length: optical depth 0 is added, and the color times
/// a difference of equal numbers. All bits are predicted.
Outcome no_length(const Gl &gl, Method &method, const Shape &shape)
{
    Outcome outcome;
    constexpr int planes = 9;
    const FaceMesh slabs = make_varied_slabs(planes);
    VolumeDrawer across(gl, method, shape, {varied_transfer()});
    const ImageRgbaF usual = across.draw(slabs);
    double changed = 0.0;
    for (std::size_t face = 0; face < slabs.interior_count; face += 2)
        for (const int times : {1, 3})
            changed += changed_pixels(across.draw(repeat_faces(slabs, face, 2, times)), usual);
    outcome.push_back({"each of 7 planes twice and 4 times: pixels that change, %", 0.0, changed});
    append_extremes(outcome, "alpha of the planes, between 0 and 1", 0.5,
                    pixel_extremes(usual, [](int, int, const glm::vec4 &p) { return p.w; }), 0.49);

    const TetGrid box = make_box(CubeSplit::five);
    const ScalarField field = unit_field(box);
    const FaceMesh faces = make_face_mesh(box, field);
    VolumeDrawer aslant(gl, method, shape, {varied_transfer(), oblique});
    const ImageRgbaF usual_box = aslant.draw(faces);
    outcome.push_back(
        {"all faces between cells of a box twice: pixels that change, %", 0.0,
         changed_pixels(aslant.draw(repeat_faces(faces, 0, faces.interior_count, 1)), usual_box)});
    TetGrid with_flat = box;
    for (std::size_t i = 0; i < box.cells.size(); ++i) {
        const glm::uvec4 &cell = box.cells[i];
        with_flat.cells.insert(with_flat.cells.begin() + static_cast<std::ptrdiff_t>(2 * i),
                               glm::uvec4(cell[0], cell[1], cell[2], cell[i % 3]));
    }
    outcome.push_back({"a cell without volume before each cell: pixels that change, %", 0.0,
                       changed_pixels(aslant.draw(make_face_mesh(with_flat, field)), usual_box)});
    return outcome;
}

/// 16. exp(-100) is 4e-44: 1 less it is 1 in single precision. A color that is the same at all
/// scalars comes from a table, between whose entries is interpolated with weights that add up to 1
/// but for some roundings: 8 * 2^-24.
Outcome range_of_exponential(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr glm::vec3 background(0.1F, 0.2F, 0.3F);
    constexpr glm::vec3 color(0.25F, 0.5F, 1.0F);
    const double tolerance = 8.0 * std::ldexp(1.0, -24);
    const FaceMesh mesh = make_slabs(make_levels(5, front, back), straight);
    const auto draw = [&](const FaceMesh &drawn, const TransferFunction &transfer) {
        return VolumeDrawer(gl, method, shape, {transfer, straight, background}).draw(drawn);
    };
    const auto alpha = [](int, int, const glm::vec4 &pixel) { return pixel.w; };
    const auto red = [](int, int, const glm::vec4 &pixel) { return pixel.x; };
    Outcome outcome;
    for (const float extinction : {100.0F, 1e30F, infinity}) {
        const auto picture = draw(mesh, make_uniform_transfer(extinction, color, color));
        append_extremes(outcome, fmt::format("extinction {}: alpha", extinction), 1.0,
                        pixel_extremes(picture, alpha));
        append_extremes(outcome, fmt::format("extinction {}: red", extinction), 0.25,
                        pixel_extremes(picture, red), tolerance);
    }
    const auto clear = draw(mesh, make_uniform_transfer(0.0F, color, color));
    append_extremes(outcome, "extinction 0: alpha", 0.0, pixel_extremes(clear, alpha));
    append_extremes(outcome, "extinction 0: red is the background's", background.x,
                    pixel_extremes(clear, red));
    // In one cell, clear in front, then a wall. Only the wall's color is red.
    const auto wall = draw(make_slabs(make_levels(2, front, back), straight),
                           must(TransferFunction::make({{0.0F, {0.0F, 1.0F, 0.0F}, 0.0F},
                                                        {0.5F, {0.0F, 1.0F, 0.0F}, 0.0F},
                                                        {0.5F, {1.0F, 0.0F, 0.0F}, infinity},
                                                        {1.0F, {1.0F, 0.0F, 0.0F}, infinity}})));
    append_extremes(outcome, "clear, then infinite: alpha", 1.0, pixel_extremes(wall, alpha));
    append_extremes(outcome, "clear, then infinite: red", 1.0, pixel_extremes(wall, red),
                    tolerance);
    return outcome;
}

/// The number of cells that the deepest ray goes through.
std::size_t deepest(const TetGrid &grid, const ScalarField &field, Size size)
{
    const integrator::RaySegments rays({grid.points, grid.cells, field.values},
                                       integrator::make_view(oblique, size));
    std::size_t most = 0;
    for (const auto &segments : rays.find(0, size.height))
        most = std::max(most, segments.size());
    return most;
}

/// 22. With an extinction of 1/2 alpha tells the length: -2 log(1 - alpha). Depths are known to 2
/// units in the last place of w (which is 2^-22 for w from 2 to 4), for each segment; alpha, which
/// is below .7, to 2^-24, which makes 2 * 2^-24 / .3 of length.
///
/// The picture's integral is a sum over pixels: it misses the volume by what the sum of the exact
/// lengths misses, by the tolerance of each length, and by what snapping changes at the outline.
Outcome thin_cells(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr double extinction = 0.5;
    Outcome outcome;
    for (const CubeSplit split : {CubeSplit::five, CubeSplit::six, CubeSplit::twenty_four}) {
        const TetGrid box = make_box(split);
        const ScalarField field = unit_field(box);
        const BoxChords chords(box, oblique, shape.size);
        const auto picture = VolumeDrawer(gl, method, shape, {white(extinction), oblique})
                                 .draw(make_face_mesh(box, field));
        const auto segments = static_cast<double>(deepest(box, field, shape.size));
        const double tolerance =
            segments * 2.0 * std::ldexp(1.0, -22) + 2.0 * std::ldexp(1.0, -24) / 0.3;
        double measured = 0.0;
        double exact = 0.0;
        double missed = 0.0;
        const Extremes beyond = pixel_extremes(picture, [&](int x, int y, const glm::vec4 &pixel) {
            const Chord chord = chords.at(x, y);
            const double length = -std::log1p(-static_cast<double>(pixel.w)) / extinction;
            measured += length * chord.volume_factor;
            exact += chord.middle * chord.volume_factor;
            missed += (tolerance + chord.greatest - chord.least) * chord.volume_factor;
            return length > chord.greatest ? length - chord.greatest
                                           : std::min(0.0, length - chord.least);
        });
        const auto name = fmt::format("{} a cube", static_cast<int>(split));
        append_extremes(outcome, name + ": sum of lengths less the chord", 0.0, beyond, tolerance);
        outcome.push_back({name + ": integral of the picture over the volume", 1.0,
                           measured / chords.volume(),
                           (std::abs(exact - chords.volume()) + missed) / chords.volume()});
    }
    return outcome;
}

/// 23. Emission s over a depth D: (1 - (1 + D) exp(-D)) / D where s rises with the distance,
/// (exp(-D) - 1 + D) / D where it falls.
Outcome preintegration(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr double tolerance = 1e-4;
    const RayLengths length(straight, shape.size);
    Outcome outcome;
    for (const double extinction : {0.1, 1.0, 10.0}) {
        const auto transfer = make_uniform_transfer(static_cast<float>(extinction), glm::vec3(0.0F),
                                                    glm::vec3(1.0F, 0.0F, 0.0F));
        VolumeDrawer drawer(gl, method, shape, {transfer});
        for (const bool rising : {true, false}) {
            const auto expected = [&](int x, int y) {
                const double depth = extinction * (back - front) * length(x, y);
                return rising ? (1.0 - (1.0 + depth) * std::exp(-depth)) / depth
                              : (std::exp(-depth) - 1.0 + depth) / depth;
            };
            for (const int cut : {1, 2, 4, 8}) {
                const FaceMesh mesh = make_slabs(
                    make_levels(cut + 1, front, back, rising ? 0.0F : 1.0F, rising ? 1.0F : 0.0F),
                    straight);
                const auto picture = drawer.draw(mesh);
                append_extremes(
                    outcome,
                    fmt::format("extinction {}, {} emission, cut in {}: color less the closed form",
                                extinction, rising ? "rising" : "falling", cut),
                    0.0,
                    pixel_extremes(picture,
                                   [&](int x, int y, const glm::vec4 &pixel) {
                                       return static_cast<double>(pixel.x) - expected(x, y);
                                   }),
                    tolerance);
            }
        }
    }
    return outcome;
}

} // namespace

std::vector<Case> volume_cases()
{
    constexpr Size small{20, 12};
    // What is about order is the renderers' own: two layers cannot be swapped from outside.
    constexpr bool about_order = false;
    return {
        {14,
         "small optical depth",
         "4096 segments of optical depth 1e-4 (1e-5) in the mean: alpha 1 - exp(-.4096) = 0.336084 "
         "(1 - exp(-.04096)) to 1e-5",
         {{"", {.k = 6, .size = {6, 4}}}},
         small_optical_depths,
         "",
         about_order},
        {15,
         "zero-length segment",
         "Two faces at one depth contribute exactly 0: inserting one anywhere changes no bit",
         // Each face twice: fragments come twice as many places late.
         {{"", {.k = 64, .size = small}}},
         no_length,
         "",
         about_order},
        {16,
         "range of exp",
         "Extinction times length 100: alpha 1, no NaN; 0: the background exactly; infinite: "
         "alpha 1",
         {{"", {.k = 6, .size = small}}},
         range_of_exponential,
         "",
         about_order},
        {22,
         "thin and degenerate tetrahedra",
         "A box in 5, 6, 24 tetrahedra a cube, jittered, with slivers of 1e-6: the lengths of "
         "segments add up to the chord, the picture to the volume",
         {{"", {.k = 32, .size = {96, 72}}}},
         thin_cells,
         "",
         about_order},
        {23,
         "pre-integration",
         "Scalar 0 to 1 across a cell, constant extinction, linear emission: the closed form to "
         "1e-4, also with the cell cut in 2, 4, 8",
         {{"", {.k = 6, .size = small}}},
         preintegration,
         "",
         about_order},
    };
}

} // namespace kb::hard
