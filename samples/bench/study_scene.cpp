// SPDX-License-Identifier: MIT

#include "bench/study_scene.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <numeric>
#include <random>

namespace kb::bench
{

namespace
{

constexpr std::size_t dragon_triangles = 871'414;

/// The engines of <random> are the same everywhere, its distributions are not.
class Random
{
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}

    float uniform(float low, float high)
    {
        const float unit = static_cast<float>(engine_() >> 8U) * 0x1p-24F;
        return low + (high - low) * unit;
    }

    std::uint32_t below(std::uint32_t bound)
    {
        return static_cast<std::uint32_t>((std::uint64_t{engine_()} * bound) >> 32U);
    }

    // Braced lists are evaluated from left to right; arguments of calls in any order.
    glm::vec3 in_unit_ball()
    {
        for (;;) {
            const glm::vec3 point{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
            if (glm::dot(point, point) <= 1.0F)
                return point;
        }
    }

    glm::vec4 color()
    {
        return glm::vec4{uniform(0.2F, 1), uniform(0.2F, 1), uniform(0.2F, 1), uniform(0.2F, 0.6F)};
    }

private:
    std::mt19937 engine_;
};

/// The view volume of x, y and z from -1 to 1; z = 1 is nearest.
glm::mat4 unit_view()
{
    return glm::ortho(-1.0F, 1.0F, -1.0F, 1.0F, -1.0F, 1.0F);
}

} // namespace

std::span<const int> default_ks(std::string_view scene)
{
    const auto found = std::ranges::find(scenes, scene, &SceneEntry::name);
    return found == scenes.end() ? std::span<const int>() : found->ks;
}

StudyScene make_spheres()
{
    constexpr int count = 300;
    StudyScene scene;
    scene.projection = unit_view();
    Random random(20140531);
    for (int i = 0; i < count; ++i) {
        // These ranges give about 11 fragments a pixel and up to about 80.
        const glm::vec3 center = 0.6F * random.in_unit_ball();
        const float radius = random.uniform(0.03F, 0.26F);
        append_sphere(scene.mesh, center, radius, random.color(), 42, 40);
    }
    return scene;
}

StudyScene make_quads()
{
    constexpr std::uint32_t count = 128;
    StudyScene scene;
    scene.projection = unit_view();
    Random random(20061106);

    std::array<std::uint32_t, count> ranks{};
    std::iota(ranks.begin(), ranks.end(), 0U);
    for (std::uint32_t i = count - 1; i > 0; --i)
        std::swap(ranks.at(i), ranks.at(random.below(i + 1)));

    for (const std::uint32_t rank : ranks) {
        const float z = 0.9F - 1.8F * static_cast<float>(rank) / static_cast<float>(count - 1);
        append_quad(scene.mesh, {-0.5F, -1.0F, z}, {1.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F},
                    random.color());
    }
    return scene;
}

StudyScene make_mesh_scene(Mesh mesh)
{
    StudyScene scene;
    glm::vec3 low = mesh.positions.at(0);
    glm::vec3 high = low;
    for (const glm::vec3 &position : mesh.positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    mesh.colors.clear();
    for (const glm::vec3 &normal : mesh.normals) {
        const glm::vec3 tint = glm::clamp(0.5F + 0.5F * normal, 0.0F, 1.0F);
        mesh.colors.emplace_back(tint, 0.3F + 0.3F * tint.y);
    }
    scene.mesh = std::move(mesh);

    // A square view about the larger of width and height, with a margin of 1 %.
    const glm::vec3 center = 0.5F * low + 0.5F * high;
    const glm::vec3 extent = high - low;
    const float half = 0.505F * std::max({extent.x, extent.y, 1e-6F});
    const float half_depth = 0.505F * std::max(extent.z, half);
    scene.projection = glm::ortho(center.x - half, center.x + half, center.y - half,
                                  center.y + half, -center.z - half_depth, -center.z + half_depth);
    return scene;
}

Result<StudyScene> make_scene(const std::string &name, const std::filesystem::path &dragon)
{
    if (name == "spheres")
        return make_spheres();
    if (name == "quads")
        return make_quads();
    if (name != "dragon")
        return Error{fmt::format("no such scene: {}", name)};
    if (std::filesystem::exists(dragon)) {
        auto loaded = load_mesh(dragon);
        if (!loaded)
            return loaded.error();
        return make_mesh_scene(std::move(loaded->mesh));
    }
    StudyScene scene = make_mesh_scene(make_knot(dragon_triangles));
    scene.note =
        fmt::format("scene dragon is a generated knot instead: no file {}", dragon.string());
    return scene;
}

} // namespace kb::bench
