// SPDX-License-Identifier: MIT

#include "volume/sorted_faces.hpp"

#include "volume/eye_place.hpp"
#include "volume/radix_sort.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <future>
#include <iterator>
#include <limits>
#include <thread>

namespace kb
{

namespace
{

constexpr int subpixel_bits = 8;
constexpr std::int32_t subpixels = 1 << subpixel_bits;

/// Drivers may put a vertex this far from where it is computed here: one step of the grid that they
/// round it to, and one for other rounding on the way.
constexpr std::int32_t slack = 2;

/// Triangles of at most this many pixels in width and height are looked at more closely.
constexpr std::int32_t few = 4;

/// Pixels with a center between two positions, and how many there are at most.
struct Pixels {
    Pixels(std::int32_t low, std::int32_t high, std::int32_t count)
        : first(std::max((low - slack + subpixels - 1) >> subpixel_bits, 0)),
          last(std::min((high + slack) >> subpixel_bits, count - 1))
    {
    }

    std::int32_t count() const { return last - first + 1; }

    std::int32_t first;
    std::int32_t last;
};

struct Point {
    std::int32_t x;
    std::int32_t y;
};

/// Twice the area of the triangle abc.
std::int32_t cross(Point a, Point b, Point c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// How much cross changes at most when its points are slack off.
std::int32_t cross_slack(Point a, Point b, Point c)
{
    const std::int32_t extent =
        std::abs(b.x - a.x) + std::abs(b.y - a.y) + std::abs(c.x - a.x) + std::abs(c.y - a.y);
    return 2 * slack * extent + 8 * slack * slack;
}

/// Whether the point is on the other side of ab than c, for sure. `side` is the sign of abc.
bool is_beyond(Point a, Point b, Point p, std::int32_t side)
{
    return side * cross(a, b, p) < -cross_slack(a, b, p);
}

/// Whether a triangle may cover one of a few pixels about it.
bool may_cover(Point a, Point b, Point c, const Pixels &columns, const Pixels &rows)
{
    const std::int32_t area = cross(a, b, c);
    if (std::abs(area) <= cross_slack(a, b, c))
        return true; // It may be the other way round.
    const std::int32_t side = area > 0 ? 1 : -1;
    for (std::int32_t row = rows.first; row <= rows.last; ++row) {
        for (std::int32_t column = columns.first; column <= columns.last; ++column) {
            const Point p{column * subpixels, row * subpixels};
            if (!is_beyond(a, b, p, side) && !is_beyond(b, c, p, side) && !is_beyond(c, a, p, side))
                return true;
        }
    }
    return false;
}

std::int32_t to_subpixels(float position)
{
    // Beyond this a face of any size is far outside of the largest picture.
    constexpr float limit = 1 << 30;
    return static_cast<std::int32_t>(
        std::clamp(position * static_cast<float>(subpixels), -limit, limit));
}

} // namespace

SortedFaces::SortedFaces(const Gl &gl, const FaceMesh &mesh, ScalarRange range, FaceOrder order)
    : gl_(&gl), range_(range), array_(gl), vertex_buffer_(gl), index_buffer_(gl),
      triangles_(mesh.triangles), interior_count_(mesh.interior_count),
      drawn_count_(mesh.drawn_count()), order_by_(order)
{
    if (order == FaceOrder::cells) {
        cell_order_.emplace(mesh);
        seen_.resize(triangles_.size());
    }
    const float extent = range.high - range.low;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        vertices_.emplace_back(mesh.positions[i], (mesh.scalars[i] - range.low) / extent);

    // A boundary vertex is another one than that of the interior at the same place.
    constexpr auto none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> boundary_vertices(vertices_.size(), none);
    for (auto i = mesh.interior_count; i < drawn_count_; ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            std::uint32_t &vertex = triangles_[i][corner];
            std::uint32_t &copy = boundary_vertices[vertex];
            if (copy == none) {
                copy = static_cast<std::uint32_t>(vertices_.size());
                vertices_.push_back(vertices_[vertex] + glm::vec4(0.0F, 0.0F, 0.0F, boundary_tag));
            }
            vertex = copy;
        }
    }

    vertices_.resize(vertices_.size() + 3);

    const auto processors =
        static_cast<std::size_t>(std::clamp(std::thread::hardware_concurrency(), 1U, 16U));
    // Inner faces are not drawn, but cells are in order by them.
    const std::size_t looked_at = cell_order_ ? triangles_.size() : drawn_count_;
    for (std::size_t i = 0; i < processors; ++i)
        chosen_.push_back({static_cast<std::uint32_t>(looked_at * i / processors),
                           static_cast<std::uint32_t>(looked_at * (i + 1) / processors),
                           {},
                           {}});

    gl.BindVertexArray(array_.id());
    upload_vertices();
    gl.VertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(0);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_.id());
    gl.BindVertexArray(0);
}

void SortedFaces::project(const OrbitCamera &camera, Size size)
{
    const glm::mat4 matrix = camera.projection(size) * camera.view();
    const glm::vec2 half(0.5F * static_cast<float>(size.width),
                         0.5F * static_cast<float>(size.height));
    projected_.resize(vertices_.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        const glm::vec4 clip = matrix * glm::vec4(glm::vec3(vertices_[i]), 1.0F);
        const glm::vec2 pixel = (glm::vec2(clip) / clip.w + 1.0F) * half - 0.5F;
        projected_[i] = {to_subpixels(pixel.x), to_subpixels(pixel.y), clip.w};
    }
}

void SortedFaces::upload_vertices() const
{
    gl_->BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.id());
    gl_->BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(glm::vec4)),
                    vertices_.data(), GL_STATIC_DRAW);
}

/// Outside of the grid's sphere there is nothing near the eye. Inside, the near plane must be
/// nearer than any face: rays that lose one do not know any more whether they are in the grid.
void SortedFaces::fit_near_plane(const OrbitCamera &camera, Size size)
{
    camera_ = camera;
    nearest_depth_ = 0.0F;
    eye_is_inside_ = false;
    if (camera.distance >= 1.02F)
        return;
    const glm::vec3 eye(glm::inverse(camera.view())[3]);
    const EyePlace place =
        find_eye(eye, std::span(vertices_).first(vertices_.size() - 3),
                 std::span(triangles_).first(drawn_count_), interior_count_, boundary_tag);
    const glm::mat4 projection = camera.projection(size);
    const glm::vec2 slopes(1.0F / projection[0][0], 1.0F / projection[1][1]);
    // The least depth at this distance is in the corners. The limits are those of floats, and of
    // the precision of depth.
    const float free =
        std::clamp(static_cast<float>(place.clearance) / std::sqrt(1.0F + glm::dot(slopes, slopes)),
                   1e-5F, 1.0F);
    camera_.nearest = 0.4F * free;
    if (!place.scalar)
        return;
    eye_is_inside_ = true;
    nearest_depth_ = 0.8F * free;
    cap_at_eye(0.6F * free, slopes, *place.scalar);
}

/// Closes the grid before an eye inside of it, by one triangle over all of the picture.
void SortedFaces::cap_at_eye(float depth, glm::vec2 slopes, float scalar)
{
    const glm::mat4 to_scene = glm::inverse(camera_.view());
    auto vertex = vertices_.end() - 3;
    for (const glm::vec2 corner : {glm::vec2(-2.0F, -2.0F), {5.0F, -2.0F}, {-2.0F, 5.0F}}) {
        const glm::vec3 place(to_scene * glm::vec4(corner * slopes * depth, -depth, 1.0F));
        *vertex++ = glm::vec4(place, scalar + boundary_tag);
    }
    gl_->BindVertexArray(array_.id());
    upload_vertices();
}

/// A face that reaches behind the eye has no place on the picture: what side the eye is on says how
/// it sees it.
static Seen see_near_eye(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &c, glm::vec3 eye)
{
    const glm::dvec3 origin(a);
    const glm::dvec3 normal = glm::cross(glm::dvec3(b) - origin, glm::dvec3(c) - origin);
    return glm::dot(normal, glm::dvec3(eye) - origin) > 0.0 ? Seen::counterclockwise
                                                            : Seen::clockwise;
}

Seen SortedFaces::see(const glm::uvec3 &triangle, glm::vec3 eye, Size size) const
{
    const Projected &a = projected_[triangle.x];
    const Projected &b = projected_[triangle.y];
    const Projected &c = projected_[triangle.z];
    if (std::max({a.depth, b.depth, c.depth}) <= 0.0F)
        return Seen::never;
    // What is very near may be too far aside for its place on the picture.
    if (!(std::min({a.depth, b.depth, c.depth}) > 0.01F))
        return see_near_eye(vertices_[triangle.x], vertices_[triangle.y], vertices_[triangle.z],
                            eye);
    const Pixels columns(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), size.width);
    const Pixels rows(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), size.height);
    if (columns.count() <= 0 || rows.count() <= 0)
        return Seen::never;
    if (columns.count() <= few && rows.count() <= few &&
        !may_cover({a.x, a.y}, {b.x, b.y}, {c.x, c.y}, columns, rows))
        return Seen::never;
    const std::int64_t area = std::int64_t(b.x - a.x) * std::int64_t(c.y - a.y) -
                              std::int64_t(c.x - a.x) * std::int64_t(b.y - a.y);
    return area > 0 ? Seen::counterclockwise : Seen::clockwise;
}

float SortedFaces::key_of(const glm::uvec3 &triangle) const
{
    const float a = projected_[triangle.x].depth;
    const float b = projected_[triangle.y].depth;
    const float c = projected_[triangle.z].depth;
    return order_by_ == FaceOrder::nearest_vertex ? std::min({a, b, c}) : a + b + c;
}

void SortedFaces::choose(Chosen &chosen, glm::vec3 eye, Size size)
{
    chosen.faces.clear();
    chosen.keys.clear();
    for (std::uint32_t i = chosen.first; i < chosen.last; ++i) {
        const Seen seen = see(triangles_[i], eye, size);
        if (cell_order_)
            seen_[i] = seen;
        const bool boundary = i >= interior_count_ && i < drawn_count_;
        if (cell_order_ ? boundary && seen == Seen::clockwise : seen != Seen::never) {
            chosen.faces.push_back(i);
            chosen.keys.push_back(key_of(triangles_[i]));
        }
    }
}

void SortedFaces::sort(const OrbitCamera &camera, Size size)
{
    fit_near_plane(camera, size);
    project(camera, size);
    const glm::vec3 eye(glm::inverse(camera.view())[3]);
    std::vector<std::future<void>> work;
    for (Chosen &chosen : chosen_)
        work.push_back(std::async(std::launch::async, [&, this] { choose(chosen, eye, size); }));
    for (auto &part : work)
        part.get();
    keyed_.clear();
    keys_.clear();
    for (const Chosen &chosen : chosen_) {
        keyed_.insert(keyed_.end(), chosen.faces.begin(), chosen.faces.end());
        keys_.insert(keys_.end(), chosen.keys.begin(), chosen.keys.end());
    }
    sort_by_key(keys_, order_);
    for (std::uint32_t &place : order_)
        place = keyed_[place];
    if (cell_order_) {
        keyed_.swap(order_);
        cell_order_->sort(seen_, keyed_, order_);
        std::erase_if(order_, [this](std::uint32_t place) { return place >= drawn_count_; });
    }

    std::vector<glm::uvec3> sorted;
    sorted.reserve(order_.size() + 1);
    if (eye_is_inside_) {
        const auto end = static_cast<std::uint32_t>(vertices_.size());
        sorted.emplace_back(end - 3, end - 2, end - 1);
    }
    std::transform(order_.begin(), order_.end(), std::back_inserter(sorted),
                   [this](std::uint32_t place) { return triangles_[place]; });
    gl_->BindVertexArray(array_.id());
    gl_->BufferData(GL_ELEMENT_ARRAY_BUFFER,
                    static_cast<GLsizeiptr>(sorted.size() * sizeof(glm::uvec3)), sorted.data(),
                    GL_STREAM_DRAW);
}

void SortedFaces::draw() const
{
    gl_->BindVertexArray(array_.id());
    const std::size_t drawn = order_.size() + (eye_is_inside_ ? 1 : 0);
    gl_->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * drawn), GL_UNSIGNED_INT, nullptr);
}

} // namespace kb
