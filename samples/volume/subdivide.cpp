// SPDX-License-Identifier: MIT

#include "volume/subdivide.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/type_precision.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

namespace kb
{

namespace
{

struct Piece {
    glm::uvec3 triangle;
    std::size_t face; ///< Of the mesh that it is a part of.
};

/// How a triangle is split.
struct Split {
    int from;     ///< The corner where the longest and the shortest edge meet.
    int to;       ///< The other end of the longest edge.
    double share; ///< Where the new vertex is on it: 0 is `from`, at most 1/2.
    double priority;

    bool operator<(const Split &other) const { return priority < other.priority; }
};

/// None for a triangle with an edge of no length: it has no surface.
std::optional<Split> find_split(const FaceMesh &mesh, const glm::uvec3 &triangle, SplitFirst first)
{
    std::array<double, 3> lengths{}; // Of the edges by the corner that they are opposite to.
    for (int i = 0; i < 3; ++i)
        lengths[std::size_t(i)] = glm::distance(glm::dvec3(mesh.positions[triangle[(i + 1) % 3]]),
                                                glm::dvec3(mesh.positions[triangle[(i + 2) % 3]]));
    // The first and the last of those that are equal, so that they are never the same edge.
    const auto by_length = {0, 1, 2};
    const auto shorter = [&lengths](int a, int b) {
        return lengths[std::size_t(a)] < lengths[std::size_t(b)];
    };
    const auto [shortest, longest] =
        std::minmax_element(by_length.begin(), by_length.end(), shorter);
    const double low = lengths[std::size_t(*shortest)];
    const double high = lengths[std::size_t(*longest)];
    if (!(low > 0.0))
        return std::nullopt;
    return Split{.from = 3 - *shortest - *longest,
                 .to = *shortest,
                 .share = std::min(low / high, 0.5),
                 .priority = first == SplitFirst::longest ? high : high / low};
}

/// The mesh that grows, and its triangles that may be split, the most urgent one on top.
class Subdivision
{
public:
    Subdivision(const FaceMesh &mesh, SplitFirst first) : mesh_(mesh), first_(first)
    {
        for (std::size_t i = 0; i < mesh.drawn_count(); ++i)
            add({mesh.triangles[i], i});
    }

    std::size_t count() const { return pieces_.size(); }

    /// Splits a triangle; false when none is left that can be.
    bool split_one()
    {
        while (!queue_.empty()) {
            const auto [split, place] = queue_.top();
            queue_.pop();
            if (const auto vertex = add_vertex(pieces_[place].triangle, split)) {
                Piece rest = pieces_[place];
                pieces_[place].triangle[split.to] = *vertex;
                rest.triangle[split.from] = *vertex;
                enqueue(place);
                add(rest);
                return true;
            }
        }
        return false;
    }

    FaceMesh finish() &&
    {
        std::stable_sort(pieces_.begin(), pieces_.end(),
                         [](const Piece &a, const Piece &b) { return a.face < b.face; });
        const auto boundary =
            std::partition_point(pieces_.begin(), pieces_.end(), [this](const Piece &piece) {
                return piece.face < mesh_.interior_count;
            });
        mesh_.interior_count = static_cast<std::size_t>(boundary - pieces_.begin());
        for (std::size_t i = mesh_.drawn_count(); i < mesh_.triangles.size(); ++i)
            pieces_.push_back({mesh_.triangles[i], i});
        const auto cells = std::exchange(mesh_.cells, {});
        mesh_.triangles.clear();
        for (const Piece &piece : pieces_) {
            mesh_.triangles.push_back(piece.triangle);
            if (!cells.empty())
                mesh_.cells.push_back(cells[piece.face]);
        }
        return std::move(mesh_);
    }

private:
    struct Candidate {
        Split split;
        std::size_t place; ///< In pieces_.

        /// Of those that are equally urgent the first one is first: the result is always the same.
        bool operator<(const Candidate &other) const
        {
            return split.priority != other.split.priority ? split < other.split
                                                          : place > other.place;
        }
    };

    void add(const Piece &piece)
    {
        pieces_.push_back(piece);
        enqueue(pieces_.size() - 1);
    }

    void enqueue(std::size_t place)
    {
        if (const auto split = find_split(mesh_, pieces_[place].triangle, first_))
            queue_.push({*split, place});
    }

    /// None where floats have no place for it between the ends of the edge.
    std::optional<std::uint32_t> add_vertex(const glm::uvec3 &triangle, const Split &split)
    {
        const std::uint32_t from = triangle[split.from];
        const std::uint32_t to = triangle[split.to];
        const glm::vec3 position(glm::mix(glm::dvec3(mesh_.positions[from]),
                                          glm::dvec3(mesh_.positions[to]), split.share));
        if (position == mesh_.positions[from] || position == mesh_.positions[to])
            return std::nullopt;
        mesh_.positions.push_back(position);
        mesh_.scalars.push_back(static_cast<float>(
            glm::mix(double(mesh_.scalars[from]), double(mesh_.scalars[to]), split.share)));
        return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
    }

    FaceMesh mesh_;
    SplitFirst first_;
    std::vector<Piece> pieces_;
    std::priority_queue<Candidate> queue_;
};

} // namespace

FaceMesh subdivide(const FaceMesh &mesh, double budget, SplitFirst first)
{
    const auto wanted = static_cast<std::size_t>(budget * static_cast<double>(mesh.drawn_count()));
    Subdivision subdivision(mesh, first);
    while (subdivision.count() < wanted && subdivision.split_one())
        continue;
    return std::move(subdivision).finish();
}

} // namespace kb
