// SPDX-License-Identifier: MIT

#include "isosurface/gradients.hpp"

#include "isosurface/particles.hpp"

#include <glm/common.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <numeric>

namespace kb
{

namespace
{

/// The points of each of the cubes that their box is cut into.
class Cubes
{
public:
    explicit Cubes(std::span<const glm::vec3> points)
        : side_(mean_spacing(points)), low_(points[0]), points_(points.size())
    {
        glm::vec3 high = points[0];
        for (const glm::vec3 &p : points) {
            low_ = glm::min(low_, p);
            high = glm::max(high, p);
        }
        // The last cubes reach up to the box's end.
        if (side_ > 0.0F)
            count_ = glm::max(glm::ivec3((high - low_) / side_), 1);
        first_.resize(std::size_t(count_.x) * std::size_t(count_.y) * std::size_t(count_.z) + 1);
        for (const glm::vec3 &p : points)
            ++first_[index(cube_of(p)) + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::uint32_t i = 0; i < points.size(); ++i)
            points_[next[index(cube_of(points[i]))]++] = i;
    }

    const glm::ivec3 &count() const { return count_; }

    std::span<const std::uint32_t> points_in(const glm::ivec3 &cube) const
    {
        const std::size_t i = index(cube);
        return std::span(points_).subspan(first_[i], first_[i + 1] - first_[i]);
    }

private:
    glm::ivec3 cube_of(const glm::vec3 &p) const
    {
        return side_ > 0.0F ? glm::min(glm::ivec3((p - low_) / side_), count_ - 1) : glm::ivec3(0);
    }

    std::size_t index(const glm::ivec3 &cube) const
    {
        const glm::uvec3 place(cube);
        const glm::uvec3 count(count_);
        return (std::size_t(place.z) * count.y + place.y) * count.x + place.x;
    }

    float side_;
    glm::vec3 low_;
    glm::ivec3 count_{1};
    std::vector<std::uint32_t> first_;  ///< Of each cube, a place in points_; the end at last.
    std::vector<std::uint32_t> points_; ///< Cube by cube.
};

/// Of points and the values there, what least squares need to know.
struct Moments {
    double count = 0.0;
    glm::dvec3 point{0.0};
    double value = 0.0;
    glm::dmat3 point_point{0.0};
    glm::dvec3 point_value{0.0};

    void add(const glm::dvec3 &p, double v)
    {
        count += 1.0;
        point += p;
        value += v;
        point_point += glm::outerProduct(p, p);
        point_value += v * p;
    }

    glm::dvec3 gradient() const
    {
        const glm::dvec3 middle = point / count;
        const glm::dvec3 slope = point_value / count - middle * (value / count);
        glm::dmat3 extent = point_point / count - glm::outerProduct(middle, middle);
        // A thousandth of the points' extent in all directions lets the matrix have an inverse, and
        // directions in which they have none no part in the gradient.
        const double least = 1e-6 * (extent[0][0] + extent[1][1] + extent[2][2]);
        if (!(least > 0.0))
            return glm::dvec3(0.0);
        return glm::inverse(extent + glm::dmat3(least)) * slope;
    }
};

} // namespace

std::vector<glm::vec3> estimate_gradients(std::span<const glm::vec3> points,
                                          std::span<const float> values)
{
    std::vector<glm::vec3> gradients(points.size());
    if (points.empty())
        return gradients;
    const Cubes cubes(points);
    const auto gradient_in = [&](const glm::ivec3 &cube) {
        const glm::ivec3 low = glm::max(cube - 1, 0);
        const glm::ivec3 high = glm::min(cube + 1, cubes.count() - 1);
        // Relative to a point nearby, which keeps differences of moments exact.
        const glm::dvec3 origin(points[cubes.points_in(cube).front()]);
        Moments moments;
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                    for (const std::uint32_t i : cubes.points_in({x, y, z}))
                        moments.add(glm::dvec3(points[i]) - origin, values[i]);
        return glm::vec3(moments.gradient());
    };
    for (int z = 0; z < cubes.count().z; ++z) {
        for (int y = 0; y < cubes.count().y; ++y) {
            for (int x = 0; x < cubes.count().x; ++x) {
                const auto inside = cubes.points_in({x, y, z});
                if (inside.empty())
                    continue;
                const glm::vec3 gradient = gradient_in({x, y, z});
                for (const std::uint32_t i : inside)
                    gradients[i] = gradient;
            }
        }
    }
    return gradients;
}

} // namespace kb
