// SPDX-License-Identifier: MIT

#include "tests/support/test_scenes.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <vector>

namespace kb::test
{

namespace
{

struct Vertex {
    glm::vec3 position;
    glm::u8vec4 color;
};

void write_ply(const std::filesystem::path &path, const std::vector<Vertex> &vertices,
               const std::vector<std::array<std::size_t, 3>> &faces)
{
    std::ofstream file(path);
    file << "ply\nformat ascii 1.0\nelement vertex " << vertices.size()
         << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty "
            "uchar green\nproperty uchar blue\nproperty uchar alpha\nelement face "
         << faces.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto &[p, c] : vertices)
        file << fmt::format("{:.9g} {:.9g} {:.9g} {} {} {} {}\n", p.x, p.y, p.z, c.r, c.g, c.b,
                            c.a);
    for (const auto &[a, b, c] : faces)
        file << fmt::format("3 {} {} {}\n", a, b, c);
}

class Soup
{
public:
    explicit Soup(unsigned seed) : random_(seed) {}

    int number(int low, int high)
    {
        // Not a std:: distribution: they differ between libraries.
        return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
    }

    float coordinate() { return static_cast<float>(number(-10000, 10000)) / 10000.0F; }

    glm::u8vec4 color()
    {
        return glm::u8vec4(number(20, 255), number(20, 255), number(20, 255), number(25, 200));
    }

    glm::vec3 point()
    {
        glm::vec3 p(2.0F);
        while (glm::length(p) > 1.0F)
            p = glm::vec3(coordinate(), coordinate(), coordinate());
        return p;
    }

    std::array<glm::vec3, 3> triangle()
    {
        std::array<glm::vec3, 3> corners{};
        do
            corners = {point(), point(), point()};
        while (glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) < 0.7F);
        return corners;
    }

    void add(const std::array<glm::vec3, 3> &corners)
    {
        const std::size_t first = vertices_.size();
        for (const glm::vec3 &corner : corners)
            vertices_.push_back({corner, color()});
        faces_.push_back({first, first + 1, first + 2});
    }

    void write(const std::filesystem::path &path) const { write_ply(path, vertices_, faces_); }

private:
    std::mt19937 random_;
    std::vector<Vertex> vertices_;
    std::vector<std::array<std::size_t, 3>> faces_;
};

} // namespace

void write_triangle_soup(const std::filesystem::path &path, int triangles, unsigned seed)
{
    Soup soup(seed);
    for (int i = 0; i < triangles; ++i)
        soup.add(soup.triangle());
    soup.write(path);
}

void write_tied_soup(const std::filesystem::path &path, int triangles, unsigned seed)
{
    Soup soup(seed);
    std::vector<std::array<glm::vec3, 3>> corners;
    for (int i = 0; i < triangles; ++i)
        corners.push_back(soup.triangle());
    for (int copy = 0; copy < 4; ++copy) {
        for (const auto &c : corners)
            soup.add(c);
    }
    soup.write(path);
}

void write_coincident_quads(const std::filesystem::path &path, int quads, unsigned seed)
{
    Soup soup(seed);
    const auto add_quad = [&soup](float z) {
        const glm::vec3 a(-0.7F, -0.6F, z);
        const glm::vec3 b(0.8F, -0.5F, z);
        const glm::vec3 c(0.6F, 0.7F, z);
        const glm::vec3 d(-0.7F, 0.5F, z);
        soup.add({a, b, c});
        soup.add({a, c, d});
    };
    add_quad(-0.3F);
    for (int i = 0; i < quads; ++i)
        add_quad(0.2F);
    soup.write(path);
}

void write_plane_stack(const std::filesystem::path &path, int planes, unsigned seed)
{
    Soup soup(seed);
    std::vector<int> order;
    for (int i = 0; i < planes; ++i)
        order.insert(order.begin() + soup.number(0, i), i);

    std::vector<Vertex> vertices;
    std::vector<std::array<std::size_t, 3>> faces;
    for (const int i : order) {
        const std::size_t first = vertices.size();
        const glm::u8vec4 color = soup.color();
        const float turn = 3.14159265F * soup.coordinate();
        for (int corner = 0; corner < 4; ++corner) {
            const float angle = turn + 1.57079633F * static_cast<float>(corner);
            vertices.push_back({glm::vec3(std::cos(angle), std::sin(angle),
                                          static_cast<float>(i) / static_cast<float>(planes)),
                                color});
        }
        faces.push_back({first, first + 1, first + 2});
        faces.push_back({first, first + 2, first + 3});
    }
    write_ply(path, vertices, faces);
}

} // namespace kb::test
