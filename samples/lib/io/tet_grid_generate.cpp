// SPDX-License-Identifier: MIT

#include "lib/io/tet_grid.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>

namespace kb
{

// Points of a cube, in half edges from its first corner; four a tetrahedron.
using Place = std::array<int, 3>;
using Tetrahedron = std::array<Place, 4>;

static constexpr Place corner(unsigned bits)
{
    return {bits & 1U ? 2 : 0, bits & 2U ? 2 : 0, bits & 4U ? 2 : 0};
}

/// Five tetrahedra; the mirrored ones have the diagonals of faces that the neighbors have.
static std::vector<Tetrahedron> split_in_five(bool mirrored)
{
    static constexpr std::array<std::array<unsigned, 4>, 5> corners{
        {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}}};
    std::vector<Tetrahedron> cells;
    for (const auto &[a, b, c, d] : corners) {
        const unsigned flip = mirrored ? 1 : 0;
        cells.push_back({corner(a ^ flip), corner(b ^ flip), corner(c ^ flip), corner(d ^ flip)});
    }
    return cells;
}

/// One for each way along three edges from the first corner to the last.
static std::vector<Tetrahedron> split_in_six()
{
    std::vector<Tetrahedron> cells;
    for (unsigned first = 0; first < 3; ++first)
        for (unsigned second = 0; second < 3; ++second)
            if (second != first)
                cells.push_back({corner(0), corner(1U << first), corner(1U << first | 1U << second),
                                 corner(7)});
    return cells;
}

/// One for each edge of each face, with the middles of the face and of the cube.
static std::vector<Tetrahedron> split_in_twenty_four()
{
    std::vector<Tetrahedron> cells;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int side : {0, 2}) {
            Place middle{1, 1, 1};
            middle[axis] = side;
            static constexpr std::array<std::array<int, 2>, 5> around{
                {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}}};
            for (std::size_t i = 0; i < 4; ++i) {
                Place from = middle;
                Place to = middle;
                for (std::size_t j = 0; j < 2; ++j) {
                    from[(axis + 1 + j) % 3] = around[i][j];
                    to[(axis + 1 + j) % 3] = around[i + 1][j];
                }
                cells.push_back({from, to, middle, Place{1, 1, 1}});
            }
        }
    }
    return cells;
}

namespace
{

/// Random numbers that are the same with every standard library.
class Random
{
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}

    /// From 0 up to 1, without it.
    float number() { return static_cast<float>(engine_() >> 8U) * 0x1p-24F; }

private:
    std::mt19937 engine_;
};

/// The points that are the corners of cubes or the middles of cubes and faces; each is made when it
/// is first asked for.
class Lattice
{
public:
    explicit Lattice(unsigned cubes) : steps_(2 * cubes), indices_(cubed(steps_ + 1), none) {}

    std::uint32_t point(const std::array<unsigned, 3> &place)
    {
        std::uint32_t &index =
            indices_[(place[2] * std::size_t{steps_ + 1} + place[1]) * (steps_ + 1) + place[0]];
        if (index == none) {
            index = static_cast<std::uint32_t>(places_.size());
            places_.push_back(place);
        }
        return index;
    }

    std::size_t size() const { return places_.size(); }
    const std::array<unsigned, 3> &place(std::size_t point) const { return places_[point]; }
    bool is_on_side(unsigned along_axis) const { return along_axis == 0 || along_axis == steps_; }

    glm::vec3 position(std::size_t point) const
    {
        glm::vec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = 2.0F * static_cast<float>(places_[point][static_cast<std::size_t>(axis)]) /
                          static_cast<float>(steps_) -
                      1.0F;
        return p;
    }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    static std::size_t cubed(std::size_t n) { return n * n * n; }

    unsigned steps_;
    std::vector<std::uint32_t> indices_;
    std::vector<std::array<unsigned, 3>> places_;
};

} // namespace

static void orient(const TetGrid &grid, glm::uvec4 &cell)
{
    if (signed_volume(grid, cell) < 0.0)
        std::swap(cell[1], cell[2]);
}

static std::vector<Tetrahedron> split_cube(CubeSplit split, bool mirrored)
{
    switch (split) {
    case CubeSplit::six:
        return split_in_six();
    case CubeSplit::twenty_four:
        return split_in_twenty_four();
    case CubeSplit::five:
        break;
    }
    return split_in_five(mirrored);
}

static void add_cubes(TetGrid &grid, Lattice &lattice, const GeneratedGrid &wanted)
{
    const std::array<std::vector<Tetrahedron>, 2> ways{split_cube(wanted.split, false),
                                                       split_cube(wanted.split, true)};
    for (unsigned z = 0; z < wanted.cubes; ++z) {
        for (unsigned y = 0; y < wanted.cubes; ++y) {
            for (unsigned x = 0; x < wanted.cubes; ++x) {
                for (const Tetrahedron &tetrahedron : ways[(x + y + z) % 2]) {
                    glm::uvec4 &cell = grid.cells.emplace_back();
                    for (int i = 0; i < 4; ++i) {
                        const Place &at = tetrahedron[static_cast<std::size_t>(i)];
                        cell[i] = lattice.point({2 * x + static_cast<unsigned>(at[0]),
                                                 2 * y + static_cast<unsigned>(at[1]),
                                                 2 * z + static_cast<unsigned>(at[2])});
                    }
                }
            }
        }
    }
    for (std::size_t i = 0; i < lattice.size(); ++i)
        grid.points.push_back(lattice.position(i));
    for (glm::uvec4 &cell : grid.cells)
        orient(grid, cell);
}

/// Moves each point, but by no more than leaves each of its cells a tenth of its volume.
static void jitter(TetGrid &grid, const Lattice &lattice, const GeneratedGrid &wanted,
                   Random &random)
{
    std::vector<std::vector<std::uint32_t>> cells_at(grid.points.size());
    std::vector<double> least(grid.cells.size());
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
        least[i] = 0.1 * signed_volume(grid, grid.cells[i]);
        for (int corner = 0; corner < 4; ++corner)
            cells_at[grid.cells[i][corner]].push_back(static_cast<std::uint32_t>(i));
    }
    const float reach = wanted.jitter * 2.0F / static_cast<float>(wanted.cubes);
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
        glm::vec3 step;
        for (int axis = 0; axis < 3; ++axis) {
            const float offset = reach * (2.0F * random.number() - 1.0F);
            const unsigned place = lattice.place(i)[static_cast<std::size_t>(axis)];
            step[axis] = lattice.is_on_side(place) ? 0.0F : offset;
        }
        const glm::vec3 origin = grid.points[i];
        const auto is_good = [&](std::uint32_t cell) {
            return signed_volume(grid, grid.cells[cell]) >= least[cell];
        };
        for (int halvings = 0; halvings < 8; ++halvings, step *= 0.5F) {
            grid.points[i] = origin + step;
            if (std::ranges::all_of(cells_at[i], is_good))
                break;
            grid.points[i] = origin;
        }
    }
}

/// Puts a point into a cell, near to one of its faces: the four cells that are made of it have
/// volumes in proportion to the weights of its corners.
static void add_sliver(TetGrid &grid, std::size_t index, float thinnest, Random &random)
{
    const glm::uvec4 cell = grid.cells[index];
    const int opposite = static_cast<int>(4.0F * random.number());
    // Rounding of the point's coordinates may flatten the sliver: then it has to be thicker.
    for (float thickness = std::pow(thinnest, 0.2F + 0.8F * random.number()); thickness < 0.25F;
         thickness *= 2.0F) {
        glm::dvec3 middle(0.0);
        for (int i = 0; i < 4; ++i) {
            const double weight =
                i == opposite ? double{thickness} : (1.0 - double{thickness}) / 3.0;
            middle += weight * glm::dvec3(grid.points[cell[i]]);
        }
        grid.points.emplace_back(middle);
        std::array<glm::uvec4, 4> parts{cell, cell, cell, cell};
        for (int i = 0; i < 4; ++i)
            parts[static_cast<std::size_t>(i)][i] =
                static_cast<std::uint32_t>(grid.points.size() - 1);
        if (std::ranges::all_of(
                parts, [&](const glm::uvec4 &part) { return signed_volume(grid, part) > 0.0; })) {
            grid.cells[index] = parts[0];
            grid.cells.insert(grid.cells.end(), parts.begin() + 1, parts.end());
            return;
        }
        grid.points.pop_back();
    }
}

float generated_wave(glm::vec3 p)
{
    // Along z it grows everywhere.
    return p.z + 0.3F * std::sin(4.0F * p.x) + 0.3F * std::cos(3.0F * p.y);
}

TetGrid make_tet_grid(const GeneratedGrid &wanted)
{
    TetGrid grid;
    Random random(wanted.seed);
    Lattice lattice(wanted.cubes);
    add_cubes(grid, lattice, wanted);
    jitter(grid, lattice, wanted, random);
    const std::size_t cells = grid.cells.size();
    for (std::size_t i = 0; i < cells; ++i) {
        if (random.number() < wanted.sliver_share)
            add_sliver(grid, i, wanted.thinnest, random);
    }

    ScalarField wave{"wave", {}};
    ScalarField distance{"distance", {}};
    for (const glm::vec3 &p : grid.points) {
        wave.values.push_back(generated_wave(p));
        distance.values.push_back(glm::length(p));
    }
    grid.fields = {std::move(wave), std::move(distance)};
    return grid;
}

} // namespace kb
