// SPDX-License-Identifier: MIT

#include "lib/io/legacy_vtk.hpp"
#include "lib/io/vtk_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <utility>

namespace kb
{

/// VTK writes a blank in a name as %20.
static std::string decode_name(std::string_view name)
{
    std::string decoded;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char *const digits = name.data() + i + 1;
        unsigned char code = 0;
        if (name[i] == '%' && i + 2 < name.size() &&
            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
            decoded += static_cast<char>(code);
            i += 2;
        } else {
            decoded += name[i];
        }
    }
    return decoded;
}

namespace
{

/// The sections of a file, one after the other. Each begins with a keyword.
class VtkReader
{
public:
    explicit VtkReader(std::string_view text, bool is_little_endian = false) : text_(text)
    {
        text_.is_little_endian = is_little_endian;
    }

    bool is_binary() const { return text_.is_binary; }

    Result<LegacyVtk> read()
    {
        read_header();
        for (std::string_view keyword = text_.word(); !keyword.empty(); keyword = text_.word())
            read_section(keyword);
        if (text_.failed())
            return Error{text_.error()};
        return std::move(vtk_);
    }

private:
    void read_header()
    {
        const std::string_view identifier = text_.line();
        constexpr std::string_view start = "# vtk DataFile Version ";
        if (!identifier.starts_with(start))
            return text_.fail("it is no legacy VTK file (scripts/convert-grid makes one of other "
                              "formats)");
        is_version_5_ = first_word(identifier.substr(start.size())).starts_with('5');
        text_.line(); // The title.
        const std::string_view form = text_.word();
        text_.is_binary = is_keyword(form, "BINARY");
        if (!text_.is_binary && !is_keyword(form, "ASCII"))
            return text_.fail(fmt::format("it is {}, not ASCII or BINARY", quoted(form)));
        if (!is_keyword(text_.word(), "DATASET"))
            return text_.fail("its header names no DATASET");
        const std::string_view data_set = text_.word();
        vtk_.is_polygonal = is_keyword(data_set, "POLYDATA");
        if (!vtk_.is_polygonal && !is_keyword(data_set, "UNSTRUCTURED_GRID"))
            text_.fail(
                fmt::format("its data set is {}, not UNSTRUCTURED_GRID (scripts/convert-grid "
                            "makes tetrahedra of it)",
                            quoted(data_set)));
    }

    void read_section(std::string_view keyword)
    {
        const auto is = [keyword](std::string_view other) { return is_keyword(keyword, other); };
        if (is("POINTS")) {
            read_points();
        } else if (is("CELLS") || is("VERTICES") || is("LINES") || is("POLYGONS") ||
                   is("TRIANGLE_STRIPS")) {
            read_cells();
        } else if (is("CELL_TYPES")) {
            vtk_.cell_types = text_.integers("int", text_.count("cell types"));
        } else if (is("POINT_DATA") || is("CELL_DATA")) {
            in_point_data_ = is("POINT_DATA");
            vtk_.has_cell_data |= !in_point_data_;
            items_ = text_.count(in_point_data_ ? "points with values" : "cells with values");
        } else if (is("FIELD")) {
            read_arrays();
        } else if (is("METADATA")) {
            skip_metadata();
        } else {
            read_attribute(keyword);
        }
    }

    void skip_metadata()
    {
        // It ends with an empty line.
        text_.line();
        while (!text_.at_end() && !first_word(text_.line()).empty()) {
        }
    }

    void read_points()
    {
        const std::size_t points = text_.count("points");
        const auto coordinates = text_.reals(text_.word(), points, 3);
        vtk_.points.resize(coordinates.size() / 3);
        for (std::size_t i = 0; i < vtk_.points.size(); ++i)
            vtk_.points[i] = {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
    }

    void read_cells()
    {
        vtk_.offsets.clear();
        vtk_.connectivity.clear();
        const std::size_t first = text_.count("cells");
        const std::size_t second = text_.count("numbers in the list of cells");
        if (is_version_5_) {
            vtk_.offsets = read_named_block("OFFSETS", first);
            vtk_.connectivity = read_named_block("CONNECTIVITY", second);
        } else {
            read_sized_lists(first, text_.integers("int", second));
        }
        const auto size = static_cast<std::int64_t>(vtk_.connectivity.size());
        if (!std::ranges::is_sorted(vtk_.offsets) ||
            (!vtk_.offsets.empty() && (vtk_.offsets.front() != 0 || vtk_.offsets.back() != size)))
            text_.fail("the offsets of its cells do not ascend from 0 to the end of the list");
        if (vtk_.is_polygonal) {
            vtk_.offsets.clear();
            vtk_.connectivity.clear();
        }
    }

    /// The cells of older versions: the number of points before the points of each.
    void read_sized_lists(std::size_t cells, const std::vector<std::int64_t> &lists)
    {
        vtk_.offsets.push_back(0);
        for (auto list = lists.begin(); list != lists.end();) {
            const std::int64_t size = *list++;
            if (size < 0 || size > lists.end() - list)
                return text_.fail(fmt::format("cell {} has {} points, but {} numbers are left",
                                              vtk_.offsets.size() - 1, size, lists.end() - list));
            vtk_.connectivity.insert(vtk_.connectivity.end(), list, list + size);
            vtk_.offsets.push_back(static_cast<std::int64_t>(vtk_.connectivity.size()));
            list += size;
        }
        if (vtk_.offsets.size() - 1 != cells)
            text_.fail(fmt::format("it says {} cells, but has {}", cells, vtk_.offsets.size() - 1));
    }

    std::vector<std::int64_t> read_named_block(const char *keyword, std::size_t items)
    {
        if (const std::string_view found = text_.word(); !is_keyword(found, keyword)) {
            text_.fail(found.empty()
                           ? "it ends early"
                           : fmt::format("{} stands where {} should", quoted(found), keyword));
            return {};
        }
        return text_.integers(text_.word(), items);
    }

    /// Arrays that tell their own size.
    void read_arrays()
    {
        text_.word(); // The name of them all.
        const std::size_t arrays = text_.count("arrays");
        for (std::size_t i = 0; i < arrays && !text_.failed(); ++i) {
            std::string_view name = text_.word();
            if (is_keyword(name, "METADATA")) { // Of the array before.
                skip_metadata();
                name = text_.word();
            }
            const std::size_t components = text_.count("components");
            const std::size_t items = text_.count("values");
            read_array(name, text_.word(), items, components);
        }
    }

    void read_array(std::string_view name, std::string_view type, std::size_t items,
                    std::size_t components)
    {
        if (VtkText::is_text(type))
            text_.skip_texts(type, items, components);
        else
            keep(name, components, text_.reals(type, items, components));
    }

    /// One array with a value for each point or cell.
    void read_attribute(std::string_view keyword)
    {
        const auto is = [keyword](std::string_view other) { return is_keyword(keyword, other); };
        const std::string_view name = text_.word();
        const std::string_view bytes = text_.is_binary ? "unsigned_char" : "float";
        if (is("SCALARS"))
            read_scalars(name);
        else if (is("VECTORS") || is("NORMALS"))
            read_array(name, text_.word(), items_, 3);
        else if (is("TENSORS"))
            skip_array(text_.word(), 9);
        else if (is("TENSORS6"))
            skip_array(text_.word(), 6);
        else if (is("GLOBAL_IDS") || is("PEDIGREE_IDS"))
            skip_array(text_.word(), 1);
        else if (is("TEXTURE_COORDINATES"))
            skip_with_components("texture coordinates", {});
        else if (is("COLOR_SCALARS"))
            skip_with_components("components", bytes);
        else if (is("LOOKUP_TABLE"))
            text_.reals(bytes, text_.count("colors"), 4);
        else
            text_.fail(fmt::format("{} stands where a section should begin", quoted(keyword)));
    }

    void skip_with_components(const char *what, std::string_view type)
    {
        const std::size_t components = text_.count(what);
        skip_array(type.empty() ? text_.word() : type, components);
    }

    void skip_array(std::string_view type, std::size_t components)
    {
        if (VtkText::is_text(type))
            text_.skip_texts(type, items_, components);
        else
            text_.reals(type, items_, components);
    }

    void read_scalars(std::string_view name)
    {
        const std::string_view type = text_.word();
        std::size_t components = 1;
        if (!text_.next_on_this_line().empty())
            components = text_.count("components");
        // The name of a lookup table may be missing.
        if (is_keyword(text_.next_line_begin(), "LOOKUP_TABLE")) {
            text_.word();
            text_.word();
        }
        read_array(name, type, items_, components);
    }

    /// Keeps an array if it is one of the points.
    void keep(std::string_view name, std::size_t components, std::vector<double> values)
    {
        if (!in_point_data_ || components == 0)
            return;
        if (components > 1) {
            const std::size_t items = values.size() / components;
            for (std::size_t i = 0; i < items; ++i) {
                double squares = 0.0;
                for (std::size_t c = 0; c < components; ++c)
                    squares += std::pow(values[i * components + c], 2.0);
                values[i] = std::sqrt(squares);
            }
            values.resize(items);
        }
        vtk_.point_arrays.push_back({decode_name(name), components, std::move(values)});
    }

    VtkText text_;
    bool is_version_5_ = false;
    bool in_point_data_ = false;
    std::size_t items_ = 0; ///< The points or cells that values follow for.
    LegacyVtk vtk_;
};

} // namespace

/// Numbers that nobody measures: almost none are in a grid, but one in five of those that are read
/// in the wrong byte order.
static std::ptrdiff_t count_absurd(std::span<const glm::dvec3> points)
{
    const auto is_absurd = [](double x) {
        return x != 0.0 && !(std::abs(x) > 1e-30 && std::abs(x) < 1e30);
    };
    return std::ranges::count_if(points, [&](const glm::dvec3 &p) {
        return is_absurd(p.x) || is_absurd(p.y) || is_absurd(p.z);
    });
}

Result<LegacyVtk> parse_legacy_vtk(std::string_view text)
{
    if (text.starts_with("\xEF\xBB\xBF")) // What some editors put in front of UTF-8.
        text.remove_prefix(3);
    VtkReader reader(text);
    auto vtk = reader.read();
    if (!reader.is_binary() || (vtk && count_absurd(vtk->points) == 0))
        return vtk;
    const auto other = VtkReader(text, true).read();
    if (other && (!vtk || count_absurd(other->points) < count_absurd(vtk->points)))
        return Error{"its binary numbers are little-endian, which the format forbids "
                     "(scripts/convert-grid reads them)"};
    return vtk;
}

} // namespace kb
