// SPDX-License-Identifier: MIT

#include "tests/hard_cases/volume_scene.hpp"

#include "bench/gl_scene.hpp"
#include "lib/gl/kbuffer.hpp"
#include "volume/sorted_faces.hpp"

#include <algorithm>

namespace kb::hard
{

using bench::must;

FaceMesh make_slabs(std::span<const Level> levels, const OrbitCamera &camera)
{
    // Twice as far to each side as the farthest plane is away: more than any view here shows.
    const auto reach = static_cast<float>(2.0 * levels.back().depth);
    FaceMesh mesh;
    for (const Level &level : levels) {
        const auto z = static_cast<float>(static_cast<double>(camera.distance) - level.depth);
        for (const glm::vec2 corner : {glm::vec2(-1.0F, -1.0F), glm::vec2(1.0F, -1.0F),
                                       glm::vec2(1.0F, 1.0F), glm::vec2(-1.0F, 1.0F)}) {
            mesh.positions.emplace_back(reach * corner, z);
            mesh.scalars.push_back(level.scalar);
        }
    }
    // Counterclockwise from the eye; those of the last plane are seen from outside, from behind.
    const auto append = [&](std::size_t level, bool from_behind) {
        const auto i = static_cast<unsigned>(4 * level);
        for (glm::uvec3 triangle : {glm::uvec3(i, i + 1, i + 2), glm::uvec3(i, i + 2, i + 3)}) {
            if (from_behind)
                std::swap(triangle.y, triangle.z);
            mesh.triangles.push_back(triangle);
        }
    };
    for (std::size_t level = 1; level + 1 < levels.size(); ++level)
        append(level, false);
    mesh.interior_count = mesh.triangles.size();
    append(0, false);
    append(levels.size() - 1, true);
    return mesh;
}

std::vector<Level> make_levels(int count, double front, double back, float first, float last)
{
    std::vector<Level> levels;
    for (int i = 0; i < count; ++i) {
        const double share = static_cast<double>(i) / (count - 1);
        levels.push_back(
            {front + share * (back - front), first + static_cast<float>(share) * (last - first)});
    }
    return levels;
}

TransferFunction make_uniform_transfer(float extinction, glm::vec3 at_0, glm::vec3 at_1)
{
    return must(TransferFunction::make({{0.0F, at_0, extinction}, {1.0F, at_1, extinction}}));
}

/// Without the nearest face through which rays enter. (One between two cells is no loss where the
/// medium is the same on both sides.)
static FaceMesh lose_nearest_face(FaceMesh mesh, const OrbitCamera &camera)
{
    const glm::mat4 view = camera.view();
    const auto depth = [&](const glm::uvec3 &triangle) {
        const glm::vec3 middle =
            mesh.positions[triangle.x] + mesh.positions[triangle.y] + mesh.positions[triangle.z];
        return -(view * glm::vec4(middle / 3.0F, 1.0F)).z;
    };
    const auto boundary = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(mesh.interior_count);
    mesh.triangles.erase(std::ranges::min_element(boundary, mesh.triangles.end(), {}, depth));
    return mesh;
}

static std::unique_ptr<VolumeRenderer> make_renderer(const Gl &gl, const Method &method,
                                                     const Shape &shape, const VolumeLook &look)
{
    VolumeSettings settings{
        .size = shape.size, .k = shape.k, .transfer = look.transfer, .background = look.background};
    if (method.name() != "depth-peeling")
        return must(make_kbuffer_renderer(gl, settings));
    settings.k = 256; // All fragments come in any case, in few passes with this.
    return must(make_exact_renderer(gl, settings));
}

VolumeDrawer::VolumeDrawer(const Gl &gl, Method &method, const Shape &shape, const VolumeLook &look)
    : gl_(gl), method_(method), size_(shape.size), camera_(look.camera),
      renderer_(make_renderer(gl, method, shape, look))
{
}

ImageRgbaF VolumeDrawer::draw(const FaceMesh &mesh)
{
    SortedFaces faces(gl_,
                      method_.take_flaw() == Flaw::none ? mesh : lose_nearest_face(mesh, camera_),
                      ScalarRange{0.0F, 1.0F});
    faces.sort(camera_, size_);
    must(renderer_->draw(faces));
    const ImageRgbaF picture = read_color(gl_, renderer_->framebuffer(), size_);
    must(check_gl(gl_, "drawing a volume"));
    return picture;
}

} // namespace kb::hard
