// SPDX-License-Identifier: MIT
//
// STL: triangles one by one, each with the normal of its plane, as text or in binary.

#include "lib/io/little_endian.hpp"
#include "lib/io/mesh_file.hpp"
#include "lib/io/text_fields.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace kb
{

namespace
{

constexpr std::size_t header_bytes = 84; ///< A comment of 80 bytes and the number of facets.
constexpr std::size_t facet_bytes = 50;  ///< A normal, three vertices and an attribute.

using Facet = std::array<glm::dvec3, 3>;

/// The normal of the file, or of the plane where the file has none. Zero for a facet without area.
glm::vec3 normal_of(glm::dvec3 given, const Facet &corners)
{
    const double length = glm::length(given);
    if (std::isfinite(length) && length > 0.0)
        return glm::vec3(given / length);
    const glm::dvec3 u = corners[1] - corners[0];
    const glm::dvec3 v = corners[2] - corners[0];
    // Of unit size first: the area of small facets could be too small for a double.
    const double size = std::max(glm::length(u), glm::length(v));
    const glm::dvec3 normal = glm::cross(u / size, v / size);
    const double area = glm::length(normal);
    return std::isfinite(area) && area > 0.0 ? glm::vec3(normal / area) : glm::vec3(0.0F);
}

void append(FileMesh &mesh, glm::dvec3 normal, const Facet &corners)
{
    const glm::vec3 shared = normal_of(normal, corners);
    for (const glm::dvec3 &corner : corners) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(corner);
        mesh.normals.push_back(shared);
    }
}

glm::dvec3 read_vector(const char *bytes)
{
    return {read_little_endian<float>(bytes), read_little_endian<float>(bytes + 4),
            read_little_endian<float>(bytes + 8)};
}

/// Colors in the attributes of facets, five bits a channel. Magics has the color of the whole in
/// the comment and bit 15 for facets that have no other; VisCAM has bit 15 for facets that have
/// one.
class FacetColors
{
public:
    explicit FacetColors(std::string_view comment)
    {
        const auto place = comment.find("COLOR=");
        if (place == std::string_view::npos || place + 10 > comment.size())
            return;
        const auto channel = [&](std::size_t i) {
            return static_cast<float>(static_cast<unsigned char>(comment[place + 6 + i])) / 255.0F;
        };
        whole_ = glm::vec4(channel(0), channel(1), channel(2), channel(3));
    }

    /// None: the file gives this facet no color.
    std::optional<glm::vec4> color(std::uint16_t attribute) const
    {
        const bool bit = (attribute & 0x8000U) != 0;
        const auto channel = [&](unsigned shift) {
            return static_cast<float>(attribute >> shift & 31U) / 31.0F;
        };
        if (whole_)
            return bit ? *whole_ : glm::vec4(channel(0), channel(5), channel(10), whole_->a);
        if (!bit)
            return std::nullopt;
        return glm::vec4(channel(10), channel(5), channel(0), 1.0F);
    }

private:
    std::optional<glm::vec4> whole_;
};

Result<FileMesh> read_binary(std::string_view content)
{
    if (content.size() < header_bytes)
        return Error{fmt::format("it ends early: a binary STL file has {} bytes before its facets",
                                 header_bytes)};
    const std::size_t count = read_little_endian<std::uint32_t>(content.data() + header_bytes - 4);
    const std::size_t room = (content.size() - header_bytes) / facet_bytes;
    if (room < count)
        return Error{fmt::format("it ends early: it has {} of {} facets", room, count)};
    if (count > std::numeric_limits<std::uint32_t>::max() / 3)
        return Error{fmt::format("its {} facets are too many", count)};

    FileMesh mesh;
    mesh.format = "binary STL";
    const FacetColors colors(content.substr(0, header_bytes - 4));
    const glm::vec4 white(1.0F);
    const char *facet = content.data() + header_bytes;
    for (std::size_t i = 0; i < count; ++i, facet += facet_bytes) {
        const auto color = colors.color(read_little_endian<std::uint16_t>(facet + 48));
        if (color) {
            mesh.colors_of = "facets";
            mesh.colors.resize(mesh.positions.size(), white);
        }
        append(mesh, read_vector(facet),
               {read_vector(facet + 12), read_vector(facet + 24), read_vector(facet + 36)});
        if (!mesh.colors.empty() || color)
            mesh.colors.resize(mesh.positions.size(), color.value_or(white));
    }
    const std::string_view tail = content.substr(header_bytes + count * facet_bytes);
    if (tail.find_first_not_of(std::string_view("\0 \t\r\n", 5)) != std::string_view::npos)
        mesh.notes.push_back(
            fmt::format("{} bytes behind its {} facets are left out", tail.size(), count));
    return mesh;
}

/// The lines of an ASCII file, which are words without regard to case.
class AsciiReader
{
public:
    explicit AsciiReader(std::string_view text) : text_(text) {}

    Result<FileMesh> read()
    {
        mesh_.format = "ASCII STL";
        while (next_line()) {
            if (auto read = read_solid(); !read)
                return Error{line_number_ > 0 && !at_end_
                                 ? fmt::format("line {}: {}", line_number_, read.error().message)
                                 : read.error().message};
        }
        return std::move(mesh_);
    }

private:
    bool next_line()
    {
        do {
            const auto line = take_line(text_);
            if (!line) {
                at_end_ = true;
                return false;
            }
            ++line_number_;
            line_ = trim(*line);
        } while (line_.empty());
        return true;
    }

    bool take(std::string_view keyword)
    {
        std::string_view rest = line_;
        if (to_lower(take_word(rest)) != keyword)
            return false;
        line_ = rest;
        return true;
    }

    Status expect(std::string_view first, std::string_view second = {})
    {
        if (!take(first) || (!second.empty() && !take(second)))
            return Error{
                fmt::format("'{}{}{}' is missing", first, second.empty() ? "" : " ", second)};
        return ok;
    }

    Status expect_line(std::string_view first, std::string_view second = {})
    {
        return next_line() ? expect(first, second) : Error{"it ends early"};
    }

    Result<glm::dvec3> vector()
    {
        glm::dvec3 v;
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = take_word(line_);
            const auto value = parse_number(word);
            if (!value)
                return Error{word.empty() ? "a number is missing"
                                          : fmt::format("'{}' is no number", word.substr(0, 40))};
            v[i] = *value;
        }
        if (!trim(line_).empty())
            return Error{"it has more than three numbers"};
        return v;
    }

    Status read_solid()
    {
        if (auto begun = expect("solid"); !begun)
            return begun;
        while (next_line()) {
            if (take("endsolid"))
                return ok;
            if (auto read = read_facet(); !read)
                return read;
        }
        return Error{"it ends early: 'endsolid' is missing"};
    }

    Status read_facet()
    {
        if (auto begun = expect("facet", "normal"); !begun)
            return begun;
        const auto normal = vector();
        if (!normal)
            return normal.error();
        if (auto begun = expect_line("outer", "loop"); !begun)
            return begun;
        Facet corners;
        for (glm::dvec3 &corner : corners) {
            if (auto begun = expect_line("vertex"); !begun)
                return begun;
            const auto place = vector();
            if (!place)
                return place.error();
            corner = *place;
        }
        for (const std::string_view end : {"endloop", "endfacet"}) {
            if (auto ended = expect_line(end); !ended)
                return ended;
        }
        append(mesh_, *normal, corners);
        return ok;
    }

    std::string_view text_;
    std::string_view line_;
    std::size_t line_number_ = 0;
    bool at_end_ = false;
    FileMesh mesh_;
};

/// A binary file's comment may begin with "solid", too, so that alone does not tell.
bool is_ascii(std::string_view content)
{
    std::string_view start = content.substr(0, 1024);
    start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
    if (to_lower(start.substr(0, 5)) != "solid")
        return false;
    if (content.size() >= header_bytes) {
        const std::size_t count =
            read_little_endian<std::uint32_t>(content.data() + header_bytes - 4);
        if (content.size() == header_bytes + count * facet_bytes)
            return false;
    }
    return start.find('\0') == std::string_view::npos;
}

} // namespace

Result<FileMesh> read_stl(std::string_view content)
{
    return is_ascii(content) ? AsciiReader(content).read() : read_binary(content);
}

} // namespace kb
