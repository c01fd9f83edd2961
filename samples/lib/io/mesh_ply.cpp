// SPDX-License-Identifier: MIT
//
// PLY: a header in text that declares elements and their properties, then their values, as text (a
// line an element) or in binary.

#include "lib/io/mesh_file.hpp"
#include "lib/io/polygon.hpp"
#include "lib/io/text_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <span>

namespace kb
{

namespace
{

enum class Scalar { i8, u8, i16, u16, i32, u32, f32, f64 };

bool is_integer(Scalar type)
{
    return type != Scalar::f32 && type != Scalar::f64;
}

std::size_t bytes_of(Scalar type)
{
    constexpr std::array<std::size_t, 8> bytes{1, 1, 2, 2, 4, 4, 4, 8};
    return bytes.at(static_cast<std::size_t>(type));
}

/// The integers that a type can hold.
struct IntegerRange {
    double low;
    double high;
};

IntegerRange range_of(Scalar type)
{
    const double bits = 8.0 * static_cast<double>(bytes_of(type));
    if (type == Scalar::u8 || type == Scalar::u16 || type == Scalar::u32)
        return {0.0, std::exp2(bits) - 1.0};
    return {-std::exp2(bits - 1.0), std::exp2(bits - 1.0) - 1.0};
}

std::optional<Scalar> scalar_named(std::string_view name)
{
    static const std::map<std::string_view, Scalar> types{
        {"char", Scalar::i8},    {"int8", Scalar::i8},     {"uchar", Scalar::u8},
        {"uint8", Scalar::u8},   {"short", Scalar::i16},   {"int16", Scalar::i16},
        {"ushort", Scalar::u16}, {"uint16", Scalar::u16},  {"int", Scalar::i32},
        {"int32", Scalar::i32},  {"uint", Scalar::u32},    {"uint32", Scalar::u32},
        {"float", Scalar::f32},  {"float32", Scalar::f32}, {"double", Scalar::f64},
        {"float64", Scalar::f64}};
    const auto found = types.find(name);
    return found == types.end() ? std::nullopt : std::optional(found->second);
}

struct Property {
    std::string name;
    Scalar type;
    std::optional<Scalar> size_type; ///< Of a list: the type of its length.
};

struct Element {
    std::string name;
    std::uint64_t count;
    std::vector<Property> properties;
};

enum class Format { ascii, little_endian, big_endian };

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
};

Result<Property> parse_property(std::string_view line)
{
    Property property;
    std::string_view type = take_word(line);
    if (type == "list") {
        property.size_type = scalar_named(take_word(line));
        if (!property.size_type || !is_integer(*property.size_type))
            return Error{"a list's length has no integer type"};
        type = take_word(line);
    }
    const auto scalar = scalar_named(type);
    if (!scalar)
        return Error{fmt::format("no such type: '{}'", type)};
    property.type = *scalar;
    property.name = take_word(line);
    if (property.name.empty() || !trim(line).empty())
        return Error{"a property has a type and a name"};
    return property;
}

Result<Format> parse_format(std::string_view line)
{
    const std::string_view format = take_word(line);
    const std::string_view version = take_word(line);
    if (version != "1.0")
        return Error{fmt::format("its format is '{} {}', not version 1.0", format, version)};
    if (format == "ascii")
        return Format::ascii;
    if (format == "binary_little_endian")
        return Format::little_endian;
    if (format == "binary_big_endian")
        return Format::big_endian;
    return Error{fmt::format("no such format: '{}'", format)};
}

/// One line of the header, without "end_header".
Status parse_header_line(std::string_view line, Header &header, bool &has_format)
{
    const std::string_view keyword = take_word(line);
    if (keyword == "comment" || keyword == "obj_info" || keyword.empty())
        return ok;
    if (keyword == "format") {
        auto format = parse_format(line);
        if (!format)
            return format.error();
        header.format = *format;
        has_format = true;
        return ok;
    }
    if (keyword == "element") {
        const std::string name(take_word(line));
        const auto count = parse_integer(take_word(line));
        if (!count || *count < 0 || !trim(line).empty())
            return Error{fmt::format("element {} has no count", name)};
        header.elements.push_back({name, static_cast<std::uint64_t>(*count), {}});
        return ok;
    }
    if (keyword != "property")
        return Error{fmt::format("its header has an unknown line: '{}'", keyword.substr(0, 40))};
    if (header.elements.empty())
        return Error{"its header has a property before the first element"};
    auto property = parse_property(line);
    if (!property)
        return Error{fmt::format("its header: {}", property.error().message)};
    header.elements.back().properties.push_back(*property);
    return ok;
}

/// Takes the header off the content.
Result<Header> take_header(std::string_view &content)
{
    Header header;
    bool has_format = false;
    if (const auto first = take_line(content); !first || *first != "ply")
        return Error{"it does not begin with a line 'ply'"};
    while (const auto line = take_line(content)) {
        if (trim(*line) == "end_header") {
            if (!has_format)
                return Error{"its header has no format"};
            return header;
        }
        if (auto parsed = parse_header_line(*line, header, has_format); !parsed)
            return parsed.error();
    }
    return Error{"its header has no end"};
}

/// The values of an ASCII file. An element is a line.
class AsciiValues
{
public:
    explicit AsciiValues(std::string_view text) : text_(text) {}

    /// Goes on to the next element.
    Status begin_element()
    {
        do {
            const auto line = take_line(text_);
            if (!line)
                return Error{"it ends early"};
            line_ = trim(*line);
        } while (line_.empty());
        return ok;
    }

    Result<double> next(Scalar type)
    {
        const std::string_view word = take_word(line_);
        if (word.empty())
            return Error{"a value is missing"};
        const auto value = parse_number(word);
        if (!value)
            return Error{fmt::format("'{}' is no number", word.substr(0, 40))};
        if (is_integer(type)) {
            const auto [low, high] = range_of(type);
            if (!(*value >= low && *value <= high && std::trunc(*value) == *value))
                return Error{fmt::format("{} does not fit the type of its property", word)};
        }
        return *value;
    }

    Status end_element() const
    {
        return trim(line_).empty() ? Status(ok) : Error{"it has more values than properties"};
    }

    /// What is left is only white.
    bool at_end() const { return text_.find_first_not_of(" \t\r\n") == std::string_view::npos; }

private:
    std::string_view text_;
    std::string_view line_;
};

class BinaryValues
{
public:
    BinaryValues(std::string_view bytes, Format format)
        : bytes_(bytes), swapped_((format == Format::little_endian) !=
                                  (std::endian::native == std::endian::little))
    {
    }

    static Status begin_element() { return ok; }
    static Status end_element() { return ok; }

    Result<double> next(Scalar type)
    {
        const std::size_t count = bytes_of(type);
        if (bytes_.size() < count)
            return Error{"it ends early"};
        std::array<char, 8> value{};
        std::memcpy(value.data(), bytes_.data(), count);
        bytes_.remove_prefix(count);
        if (swapped_)
            std::reverse(value.begin(), value.begin() + static_cast<std::ptrdiff_t>(count));
        switch (type) {
        case Scalar::i8:
            return as<std::int8_t>(value);
        case Scalar::u8:
            return as<std::uint8_t>(value);
        case Scalar::i16:
            return as<std::int16_t>(value);
        case Scalar::u16:
            return as<std::uint16_t>(value);
        case Scalar::i32:
            return as<std::int32_t>(value);
        case Scalar::u32:
            return as<std::uint32_t>(value);
        case Scalar::f32:
            return as<float>(value);
        case Scalar::f64:
            return as<double>(value);
        }
        return Error{"a type that is none"};
    }

    bool at_end() const { return bytes_.find_first_not_of(" \t\r\n") == std::string_view::npos; }

private:
    template <class T>
    static double as(const std::array<char, 8> &bytes)
    {
        T value;
        std::memcpy(&value, bytes.data(), sizeof value);
        return static_cast<double>(value);
    }

    std::string_view bytes_;
    bool swapped_;
};

/// Values of one element: one for each scalar property, and those of one list.
struct Row {
    std::vector<double> scalars; ///< By index of the property; 0 for lists.
    std::vector<double> list;
};

/// Reads all of an element. `list` is the index of the list that `take` wants, if any.
template <class Values, class Take>
Status read_element(Values &values, const Element &element, std::optional<std::size_t> list,
                    Take &&take)
{
    const auto &properties = element.properties;
    // Without properties there is nothing to read, however many there are.
    const std::uint64_t count = properties.empty() ? 0 : element.count;
    Row row{std::vector<double>(properties.size()), {}};
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto fail = [&](const Error &error) {
            return Error{fmt::format("{} {} of {}: {}", element.name, i, count, error.message)};
        };
        if (auto begun = values.begin_element(); !begun)
            return fail(begun.error());
        for (std::size_t p = 0; p < properties.size(); ++p) {
            const auto value = values.next(properties[p].size_type.value_or(properties[p].type));
            if (!value)
                return fail(value.error());
            row.scalars[p] = *value;
            if (!properties[p].size_type)
                continue;
            if (*value < 0.0)
                return fail(Error{"a list has a negative length"});
            if (p == list)
                row.list.clear();
            for (double j = 0.0; j < *value; ++j) {
                const auto item = values.next(properties[p].type);
                if (!item)
                    return fail(item.error());
                if (p == list)
                    row.list.push_back(*item);
            }
        }
        if (auto ended = values.end_element(); !ended)
            return fail(ended.error());
        if (auto taken = take(row); !taken)
            return fail(taken.error());
    }
    return ok;
}

std::optional<std::size_t> find_property(const Element &element, std::string_view name,
                                         bool is_list = false)
{
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const Property &property = element.properties[i];
        if (property.name == name && property.size_type.has_value() == is_list)
            return i;
    }
    return std::nullopt;
}

/// Three scalar properties by their names.
using Triple = std::array<std::size_t, 3>;

std::optional<Triple> find_triple(const Element &element, const std::array<const char *, 3> &names)
{
    Triple found{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto property = find_property(element, names.at(i));
        if (!property)
            return std::nullopt;
        found.at(i) = *property;
    }
    return found;
}

/// The color of an element, if it has one: integers reach from 0 to the largest of their type,
/// floats from 0 to 1.
class ColorColumns
{
public:
    explicit ColorColumns(const Element &element)
    {
        struct Names {
            std::array<const char *, 3> rgb;
            const char *alpha;
        };
        for (const Names &names : {Names{{"red", "green", "blue"}, "alpha"},
                                   Names{{"diffuse_red", "diffuse_green", "diffuse_blue"}, "alpha"},
                                   Names{{"r", "g", "b"}, "a"}}) {
            rgb_ = find_triple(element, names.rgb);
            alpha_ = find_property(element, names.alpha);
            if (rgb_)
                break;
        }
        for (const Property &property : element.properties)
            scales_.push_back(is_integer(property.type) ? 1.0 / range_of(property.type).high : 1.0);
    }

    bool exist() const { return rgb_.has_value(); }

    glm::vec4 color(const Row &row) const
    {
        const auto value = [&](std::size_t property) {
            return static_cast<float>(row.scalars[property] * scales_[property]);
        };
        return {value((*rgb_)[0]), value((*rgb_)[1]), value((*rgb_)[2]),
                alpha_ ? value(*alpha_) : 1.0F};
    }

private:
    std::optional<Triple> rgb_;
    std::optional<std::size_t> alpha_;
    std::vector<double> scales_;
};

/// Faces of the file; their vertices may come behind them.
struct Faces {
    std::vector<std::uint32_t> corners; ///< Of all faces, one after the other.
    std::vector<std::size_t> ends;      ///< In `corners`.
    std::vector<glm::vec4> colors;      ///< One a face, or empty.
};

class Reader
{
public:
    template <class Values>
    Status read(const Header &header, Values values)
    {
        for (const Element &element : header.elements) {
            if (auto done = read(element, values); !done)
                return done;
        }
        if (!values.at_end())
            mesh_.notes.emplace_back(
                "what follows behind the elements that its header declares is left out");
        return ok;
    }

    Result<FileMesh> finish(Format format) &&
    {
        mesh_.format = format == Format::ascii ? "ASCII PLY" : "binary PLY";
        if (auto checked = check_indices(); !checked)
            return checked.error();
        if (faces_.colors.empty() || !mesh_.colors.empty())
            add_faces();
        else
            add_colored_faces();
        add_strips();
        if (small_faces_ > 0)
            mesh_.notes.push_back(
                fmt::format("{} faces of less than three corners are left out", small_faces_));
        return std::move(mesh_);
    }

private:
    template <class Values>
    Status read(const Element &element, Values &values)
    {
        if (element.name == "vertex")
            return read_vertices(element, values);
        if (element.name == "face" || element.name == "tristrips") {
            auto list = find_property(element, "vertex_indices", true);
            if (!list)
                list = find_property(element, "vertex_index", true);
            if (!list || !is_integer(element.properties[*list].type))
                return Error{
                    fmt::format("element {} has no list vertex_indices of integers", element.name)};
            return element.name == "face" ? read_faces(element, *list, values)
                                          : read_strips(element, *list, values);
        }
        if (element.count > 0)
            mesh_.notes.push_back(fmt::format("its element '{}' is left out", element.name));
        return read_element(values, element, {}, [](const Row &) -> Status { return ok; });
    }

    template <class Values>
    Status read_vertices(const Element &element, Values &values)
    {
        const auto place = find_triple(element, {"x", "y", "z"});
        if (!place)
            return Error{"its vertices have no x, y and z"};
        const auto normal = find_triple(element, {"nx", "ny", "nz"});
        const ColorColumns colors(element);
        if (colors.exist())
            mesh_.colors_of = "vertices";
        return read_element(values, element, {}, [&](const Row &row) -> Status {
            if (mesh_.positions.size() == std::numeric_limits<std::uint32_t>::max())
                return Error{"there are too many"};
            const auto vector = [&row](const Triple &t) {
                return glm::dvec3(row.scalars[t[0]], row.scalars[t[1]], row.scalars[t[2]]);
            };
            mesh_.positions.push_back(vector(*place));
            if (normal)
                mesh_.normals.emplace_back(vector(*normal));
            if (colors.exist())
                mesh_.colors.push_back(colors.color(row));
            return ok;
        });
    }

    template <class Values>
    Status read_faces(const Element &element, std::size_t list, Values &values)
    {
        const ColorColumns colors(element);
        return read_element(values, element, list, [&](const Row &row) -> Status {
            small_faces_ += row.list.size() < 3;
            for (const double index : row.list) {
                if (index < 0.0)
                    return Error{fmt::format("it has index {}", index)};
                faces_.corners.push_back(static_cast<std::uint32_t>(index));
            }
            faces_.ends.push_back(faces_.corners.size());
            if (colors.exist())
                faces_.colors.push_back(colors.color(row));
            return ok;
        });
    }

    template <class Values>
    Status read_strips(const Element &element, std::size_t list, Values &values)
    {
        return read_element(values, element, list, [&](const Row &row) -> Status {
            for (const double index : row.list) {
                if (index < -1.0)
                    return Error{fmt::format("it has index {}", index)};
                strips_.push_back(index < 0.0 ? restart : static_cast<std::uint32_t>(index));
            }
            strips_.push_back(restart);
            return ok;
        });
    }

    Status check_indices() const
    {
        const std::size_t count = mesh_.positions.size();
        for (std::size_t face = 0, i = 0; face < faces_.ends.size(); ++face) {
            for (; i < faces_.ends[face]; ++i) {
                if (faces_.corners[i] >= count)
                    return Error{fmt::format("face {} has index {}, but there are {} vertices",
                                             face, faces_.corners[i], count)};
            }
        }
        for (const std::uint32_t index : strips_) {
            if (index != restart && index >= count)
                return Error{
                    fmt::format("a strip has index {}, but there are {} vertices", index, count)};
        }
        return ok;
    }

    /// Of three corners or more.
    template <class Action>
    void for_each_face(Action &&action) const
    {
        std::size_t begin = 0;
        for (std::size_t face = 0; face < faces_.ends.size(); begin = faces_.ends[face++]) {
            const std::size_t count = faces_.ends[face] - begin;
            if (count >= 3)
                action(face, std::span(faces_.corners).subspan(begin, count));
        }
    }

    void add_faces()
    {
        for_each_face([this](std::size_t, std::span<const std::uint32_t> corners) {
            triangulate(mesh_.positions, corners, mesh_.indices);
        });
    }

    /// Each face has vertices of its own, of its color.
    void add_colored_faces()
    {
        FileMesh apart;
        const bool has_normals = !mesh_.normals.empty();
        for_each_face([&](std::size_t face, std::span<const std::uint32_t> corners) {
            std::vector<std::uint32_t> own;
            for (const std::uint32_t corner : corners) {
                own.push_back(static_cast<std::uint32_t>(apart.positions.size()));
                apart.positions.push_back(mesh_.positions[corner]);
                if (has_normals)
                    apart.normals.push_back(mesh_.normals[corner]);
                apart.colors.push_back(faces_.colors[face]);
            }
            triangulate(apart.positions, own, apart.indices);
        });
        // Strips have no colors, and white is what has none where others have.
        const auto first = static_cast<std::uint32_t>(apart.positions.size());
        for (std::uint32_t &index : strips_)
            index += index == restart ? 0 : first;
        if (!strips_.empty()) {
            apart.positions.insert(apart.positions.end(), mesh_.positions.begin(),
                                   mesh_.positions.end());
            apart.normals.insert(apart.normals.end(), mesh_.normals.begin(), mesh_.normals.end());
            apart.colors.resize(apart.positions.size(), glm::vec4(1.0F));
        }
        apart.notes = std::move(mesh_.notes);
        apart.format = std::move(mesh_.format);
        apart.colors_of = "faces";
        mesh_ = std::move(apart);
    }

    /// Every second triangle of a strip is turned. Indices that come twice join strips.
    void add_strips()
    {
        std::size_t begin = 0;
        for (std::size_t i = 0; i < strips_.size(); ++i) {
            if (strips_[i] == restart) {
                begin = i + 1;
                continue;
            }
            if (i - begin < 2)
                continue;
            std::uint32_t a = strips_[i - 2];
            std::uint32_t b = strips_[i - 1];
            const std::uint32_t c = strips_[i];
            if ((i - begin) % 2 == 1)
                std::swap(a, b);
            if (a != b && b != c && c != a)
                mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
        }
    }

    static constexpr std::uint32_t restart = std::numeric_limits<std::uint32_t>::max();

    FileMesh mesh_;
    Faces faces_;
    std::vector<std::uint32_t> strips_; ///< One after the other, each with `restart` at its end.
    std::size_t small_faces_ = 0;
};

} // namespace

Result<FileMesh> read_ply(std::string_view content)
{
    const auto header = take_header(content);
    if (!header)
        return header.error();
    Reader reader;
    auto done = header->format == Format::ascii
                    ? reader.read(*header, AsciiValues(content))
                    : reader.read(*header, BinaryValues(content, header->format));
    if (!done)
        return done.error();
    return std::move(reader).finish(header->format);
}

} // namespace kb
