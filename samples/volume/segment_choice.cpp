// SPDX-License-Identifier: MIT

#include "volume/segment_choice.hpp"

#include "volume/ray_chords.hpp"
#include "volume/segment_opacity.hpp"
#include "volume/segment_texture.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

namespace kb
{

namespace
{

/// Prime numbers: ends of parts do not fall onto steps of a transfer function at 1/4, 1/10...
constexpr std::array<int, 8> numbers_of_parts{1, 2, 3, 5, 7, 11, 17, 31};
constexpr double allowed = 1.0 / 255.0;
/// Of the rays that are tried; others may be worse.
constexpr double allowed_of_parts = allowed / 4.0;

struct Segment {
    double front;
    double back;
    double length;
};

/// Of a ray, in front of a background.
struct Light {
    glm::dvec3 color{0.0};
    double alpha = 0.0;

    void add(glm::dvec3 color_times_alpha, double segment_alpha)
    {
        color += (1.0 - alpha) * color_times_alpha;
        alpha += (1.0 - alpha) * segment_alpha;
    }

    /// The greatest difference of a color in front of any background from black to white.
    double difference(const Light &other) const
    {
        double most = 0.0;
        for (int c = 0; c < 3; ++c) {
            const double on_black = color[c] - other.color[c];
            const double on_white = on_black - (alpha - other.alpha);
            most = std::max({most, std::abs(on_black), std::abs(on_white)});
        }
        return most;
    }
};

void add_optics(Light &light, const glm::dvec3 &thin, double extinction, const glm::dvec3 &change,
                double length)
{
    const SegmentOpacity opacity = segment_opacity(static_cast<float>(0.5 * extinction * length));
    light.add(thin * double(opacity.alpha) + change * double(opacity.fading), opacity.alpha);
}

/// What a lookup finds of a segment.
using LookUp = std::function<void(Light &, const Segment &)>;

/// The nearest texel of a PackedSegmentTexture.
LookUp look_up_texel(const TransferFunction &transfer)
{
    return [&transfer](Light &light, const Segment &segment) {
        using Packed = PackedSegmentTexture;
        constexpr double half_difference = PreintegratedTable::half_difference;
        const TableSize size = table_size({});
        const TablePlace place(size);
        const double sum = segment.front + segment.back;
        const double difference = segment.back - segment.front;
        const auto texel = [](double at, int count) {
            return std::clamp(static_cast<int>(at), 0, count - 1);
        };
        const int column = texel(sum * place.sum_scale + place.sum_offset, size.means);
        const int row =
            texel(difference / (std::abs(difference) + half_difference) * place.difference_scale +
                      place.difference_offset,
                  size.differences);
        const SegmentEntry entry = PreintegratedTable::entry(transfer, size, column, row);
        const glm::dvec4 packed(
            Packed::pack(entry.thin, entry.fading, PreintegratedTable::difference(size, row)));
        const glm::dvec3 whole = glm::floor(glm::dvec3(packed));
        const double change_range =
            Packed::change_range * std::max(std::abs(difference), Packed::least_difference);
        add_optics(light, whole / Packed::color_steps, 2.0 * packed.w,
                   (glm::dvec3(packed) - whole - 0.5) * change_range, segment.length);
    };
}

/// Parts as they are at the texels of SegmentTextures. What is between texels is nearly linear.
LookUp look_up_parts(const TransferFunction &transfer, int parts)
{
    return [&transfer, parts](Light &light, const Segment &segment) {
        const double difference = (segment.back - segment.front) / parts;
        const double least = std::copysign(std::max(std::abs(difference), 1e-6), difference);
        for (int i = 0; i < parts; ++i) {
            const SegmentEntry entry =
                integrate_entry(transfer, segment.front + (i + 0.5) * difference, least);
            add_optics(light, glm::dvec3(entry.thin), entry.thin.w,
                       least * glm::dvec3(entry.fading), segment.length / parts);
        }
    };
}

/// The integral over the segment.
void integrate(Light &light, const TransferFunction &transfer, const Segment &segment)
{
    const SegmentOptics optics =
        integrate_segment(transfer, static_cast<float>(segment.front),
                          static_cast<float>(segment.back), static_cast<float>(segment.length));
    const double alpha = -std::expm1(-double(optics.extinction) * segment.length);
    light.add(glm::dvec3(optics.color) * alpha, alpha);
}

/// How much light changes in a cell, at most: as emission and extinction do over its scalars, times
/// its length.
class Stakes
{
public:
    Stakes(const TetGrid &grid, std::span<const double> scalars, const TransferFunction &transfer)
        : grid_(grid), scalars_(scalars), transfer_(transfer)
    {
    }

    double of(std::uint32_t index) const
    {
        const glm::uvec4 &cell = grid_.cells[index];
        const auto [low, high] =
            std::minmax({scalars_[cell.x], scalars_[cell.y], scalars_[cell.z], scalars_[cell.w]});
        glm::vec4 least(std::numeric_limits<float>::infinity());
        glm::vec4 most(0.0F);
        const auto add = [&](const TransferPoint &point) {
            const float extinction = std::min(point.extinction, PreintegratedTable::max_extinction);
            const glm::vec4 light(point.color * extinction, extinction);
            least = glm::min(least, light);
            most = glm::max(most, light);
        };
        add(transfer_.at(static_cast<float>(low)));
        add(transfer_.at(static_cast<float>(high)));
        for (const TransferPoint &point : transfer_.points()) {
            if (point.value > low && point.value < high)
                add(point);
        }
        const glm::vec4 change = most - least;
        return std::max({change.x, change.y, change.z, change.w}) * length_of(cell);
    }

private:
    double length_of(const glm::uvec4 &cell) const
    {
        float longest = 0.0F;
        for (int i = 1; i < 4; ++i) {
            for (int j = 0; j < i; ++j)
                longest =
                    std::max(longest, glm::distance(grid_.points[cell[i]], grid_.points[cell[j]]));
        }
        return longest;
    }

    const TetGrid &grid_;
    std::span<const double> scalars_;
    const TransferFunction &transfer_;
};

/// Of a sequence that fills the numbers from 0 to 1 evenly, wherever it is cut off.
double evenly(std::size_t i, double step)
{
    const double at = static_cast<double>(i + 1) * step;
    return at - std::floor(at);
}

/// Through a place in a cell.
Ray ray_through(const TetGrid &grid, std::uint32_t cell, std::size_t i)
{
    // Irrational numbers that have little to do with one another.
    const double z = 2.0 * evenly(i, 0.7548776662466927) - 1.0;
    const double turn = 2.0 * std::numbers::pi * evenly(i, 0.5698402909980532);
    const double across = std::sqrt(1.0 - z * z);
    glm::dvec4 shares(evenly(i, 0.8191725133961645), evenly(i, 0.6710436067037893),
                      evenly(i, 0.5497004779019703), evenly(i, 0.4142135623730951));
    shares /= shares.x + shares.y + shares.z + shares.w;
    glm::dvec3 place(0.0);
    for (int c = 0; c < 4; ++c)
        place += shares[c] * glm::dvec3(grid.points[grid.cells[cell][c]]);
    return {place, glm::dvec3(across * std::cos(turn), across * std::sin(turn), z)};
}

std::vector<Ray> choose_rays(const TetGrid &grid, const Stakes &stakes)
{
    // Each ray is tried with each cell: of many cells fewer are enough, as rays cross more of them.
    const std::size_t cells = grid.cells.size();
    const std::size_t count = std::clamp<std::size_t>(10'000'000 / cells, 64, 256);
    std::vector<double> at_stake(cells);
    std::vector<std::uint32_t> order(cells);
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::transform(order, at_stake.begin(), [&](auto cell) { return stakes.of(cell); });
    const std::size_t worst = std::min(count / 2, cells);
    std::ranges::partial_sort(order, order.begin() + static_cast<std::ptrdiff_t>(worst),
                              [&](auto a, auto b) { return at_stake[a] > at_stake[b]; });
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i)
        rays.push_back(ray_through(
            grid, i % 2 == 0 ? order[i / 2 % worst] : static_cast<std::uint32_t>(i * cells / count),
            i));
    return rays;
}

/// Chords of the same cluster, one behind the other, are one segment.
std::vector<Segment> make_segments(std::span<const RayChord> chords, const CellClusters *clusters)
{
    std::vector<Segment> segments;
    for (std::size_t i = 0; i < chords.size(); ++i) {
        const RayChord &chord = chords[i];
        const double length = chord.end - chord.begin;
        if (clusters && i > 0 && clusters->join(chords[i - 1].cell, chord.cell) &&
            chord.begin - chords[i - 1].end < 1e-6) {
            segments.back().back = chord.back;
            segments.back().length += length;
        } else {
            segments.push_back({chord.front, chord.back, length});
        }
    }
    return segments;
}

} // namespace

SegmentChoice choose_lookup(const TetGrid &grid, std::span<const float> values, ScalarRange range,
                            const TransferFunction &transfer, const CellClusters *clusters)
{
    std::vector<double> scalars;
    for (const float value : values)
        scalars.push_back((double(value) - double(range.low)) /
                          (double(range.high) - double(range.low)));
    const std::vector<Ray> rays = choose_rays(grid, Stakes(grid, scalars, transfer));
    std::vector<std::vector<Segment>> segments;
    std::vector<Light> right;
    for (const auto &chords : find_chords(grid, scalars, rays)) {
        segments.push_back(make_segments(chords, clusters));
        Light light;
        for (const Segment &segment : segments.back())
            integrate(light, transfer, segment);
        right.push_back(light);
    }
    const auto error_of = [&](const LookUp &look_up) {
        double most = 0.0;
        for (std::size_t i = 0; i < segments.size(); ++i) {
            Light light;
            for (const Segment &segment : segments[i])
                look_up(light, segment);
            most = std::max(most, light.difference(right[i]));
        }
        return most;
    };

    SegmentChoice choice{{}, error_of(look_up_texel(transfer)), rays.size()};
    if (choice.error <= allowed)
        return choice;
    for (const int parts : numbers_of_parts) {
        const double error = error_of(look_up_parts(transfer, parts));
        if (error < 0.9 * choice.error)
            choice = {{parts}, error, rays.size()};
        if (error <= allowed_of_parts)
            break;
    }
    return choice;
}

} // namespace kb
