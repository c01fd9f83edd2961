// SPDX-License-Identifier: MIT

#include "legacy_vtk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

namespace kb
{

static const char *const convert_hint = "(scripts/convert-grid makes tetrahedra of it)";

static std::string_view first_word(std::string_view line)
{
    const auto begin = std::min(line.find_first_not_of(" \t\r"), line.size());
    return line.substr(begin, line.find_first_of(" \t\r", begin) - begin);
}

static bool is_keyword(std::string_view word, std::string_view keyword)
{
    const auto same = [](char a, char b) { return (a >= 'a' && a <= 'z' ? a - 32 : a) == b; };
    return std::ranges::equal(word, keyword, same);
}

template <class T>
static std::optional<T> to_number(std::string_view word)
{
    if (word.starts_with('+'))
        word.remove_prefix(1);
    T value{};
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    // A number too small for the type is read as zero, one too large is none.
    if (code == std::errc::result_out_of_range && std::floating_point<T> &&
        word.find("e-") != std::string_view::npos)
        return T{};
    if (code != std::errc{} || end != word.data() + word.size())
        return std::nullopt;
    return value;
}

/// VTK writes the blanks of a name as %20.
static std::string decode_name(std::string_view name)
{
    std::string decoded;
    for (std::size_t i = 0; i < name.size(); ++i) {
        unsigned code = 0;
        const char *const digits = name.data() + i + 1;
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

/// Reads a file's text from front to back. The first thing that is wrong is kept as the error, and
/// ends the text: what is read after it is empty, zero and of no meaning.
class VtkReader
{
public:
    explicit VtkReader(std::string_view text) : rest_(text) {}

    Result<LegacyVtk> read()
    {
        read_header();
        for (std::string_view keyword = word(); !keyword.empty(); keyword = word())
            read_section(keyword);
        if (!error_.empty())
            return Error{error_};
        return std::move(vtk_);
    }

private:
    void fail(const std::string &reason)
    {
        if (error_.empty())
            error_ = reason;
        rest_ = {};
    }

    std::string_view line()
    {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        const std::string_view taken = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        return taken;
    }

    /// The next word; empty at the end.
    std::string_view word()
    {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
        const std::string_view taken = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
        rest_.remove_prefix(taken.size());
        return taken;
    }

    std::size_t count(const char *of_what)
    {
        const std::string_view digits = word();
        if (const auto number = to_number<std::int64_t>(digits); number && *number >= 0)
            return static_cast<std::size_t>(*number);
        fail(digits.empty() ? "it ends early"
                            : fmt::format("the number of {} is '{}'", of_what, digits));
        return 0;
    }

    /// As many binary numbers of type Stored.
    template <class Stored, class T>
    std::vector<T> binary_numbers(std::size_t wanted)
    {
        if (wanted > rest_.size() / sizeof(Stored)) {
            fail("a block of binary numbers is cut off");
            return {};
        }
        std::vector<T> numbers(wanted);
        for (std::size_t i = 0; i < wanted; ++i) {
            std::array<unsigned char, sizeof(Stored)> bytes{};
            std::memcpy(bytes.data(), rest_.data() + i * sizeof(Stored), sizeof(Stored));
            if constexpr (std::endian::native == std::endian::little)
                std::ranges::reverse(bytes);
            numbers[i] = static_cast<T>(std::bit_cast<Stored>(bytes));
        }
        rest_.remove_prefix(wanted * sizeof(Stored));
        return numbers;
    }

    template <class Stored, class T>
    std::vector<T> ascii_numbers(std::size_t wanted)
    {
        // Each needs a digit and a blank.
        if (wanted > rest_.size() / 2 + 1) {
            fail("it ends early");
            return {};
        }
        // Characters are written as numbers.
        using Parsed = std::conditional_t<sizeof(Stored) == 1, int, Stored>;
        std::vector<T> numbers(wanted);
        for (T &number : numbers) {
            const std::string_view digits = word();
            const auto parsed = to_number<Parsed>(digits);
            if (!parsed) {
                fail(digits.empty() ? "it ends early"
                                    : fmt::format("'{}' is not a number", digits.substr(0, 40)));
                return {};
            }
            number = static_cast<T>(*parsed);
        }
        return numbers;
    }

    template <class Stored, class T>
    std::vector<T> numbers_stored_as(std::size_t wanted)
    {
        if (!is_binary_)
            return ascii_numbers<Stored, T>(wanted);
        line(); // The block begins after the end of the line that announces it.
        return binary_numbers<Stored, T>(wanted);
    }

    template <class T>
    std::vector<T> numbers(std::string_view type, std::size_t items, std::size_t components = 1)
    {
        // More than this no file holds, and the product cannot overflow.
        if (items > rest_.size() || components > rest_.size()) {
            fail("it ends early");
            return {};
        }
        const std::size_t wanted = items * components;
        if (is_keyword(type, "FLOAT"))
            return numbers_stored_as<float, T>(wanted);
        if (is_keyword(type, "DOUBLE"))
            return numbers_stored_as<double, T>(wanted);
        if (is_keyword(type, "INT") || is_keyword(type, "VTKIDTYPE"))
            return numbers_stored_as<std::int32_t, T>(wanted);
        if (is_keyword(type, "UNSIGNED_INT"))
            return numbers_stored_as<std::uint32_t, T>(wanted);
        if (is_keyword(type, "LONG") || is_keyword(type, "VTKTYPEINT64"))
            return numbers_stored_as<std::int64_t, T>(wanted);
        if (is_keyword(type, "UNSIGNED_LONG") || is_keyword(type, "VTKTYPEUINT64"))
            return numbers_stored_as<std::uint64_t, T>(wanted);
        if (is_keyword(type, "SHORT"))
            return numbers_stored_as<std::int16_t, T>(wanted);
        if (is_keyword(type, "UNSIGNED_SHORT"))
            return numbers_stored_as<std::uint16_t, T>(wanted);
        if (is_keyword(type, "CHAR"))
            return numbers_stored_as<signed char, T>(wanted);
        if (is_keyword(type, "UNSIGNED_CHAR"))
            return numbers_stored_as<unsigned char, T>(wanted);
        fail(type.empty() ? "it ends early"
                          : fmt::format("numbers of type '{}' are unknown", type));
        return {};
    }

    void read_header()
    {
        const std::string_view identifier = line();
        constexpr std::string_view start = "# vtk DataFile Version ";
        if (!identifier.starts_with(start))
            return fail(
                "it is no legacy VTK file (scripts/convert-grid makes one of other formats)");
        is_version_5_ = first_word(identifier.substr(start.size())).starts_with('5');
        line(); // The title.
        const std::string_view form = first_word(line());
        is_binary_ = is_keyword(form, "BINARY");
        if (!is_binary_ && !is_keyword(form, "ASCII"))
            return fail(fmt::format("it is neither ASCII nor BINARY, but '{}'", form));
        if (!is_keyword(word(), "DATASET"))
            return fail("its header names no DATASET");
        const std::string_view data_set = word();
        if (is_keyword(data_set, "POLYDATA"))
            vtk_.data_set = VtkDataSet::polygonal_data;
        else if (!is_keyword(data_set, "UNSTRUCTURED_GRID"))
            fail(fmt::format("its data set is {}, not UNSTRUCTURED_GRID {}", data_set,
                             convert_hint));
    }

    void read_section(std::string_view keyword)
    {
        if (is_keyword(keyword, "POINTS"))
            return read_points();
        if (is_keyword(keyword, "CELLS"))
            return read_cells();
        if (is_keyword(keyword, "CELL_TYPES")) {
            const std::size_t types = count("cell types");
            vtk_.cell_types = numbers<int>("int", types);
            return;
        }
        for (const char *const polygons : {"VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS"})
            if (is_keyword(keyword, polygons))
                return read_cells();
        if (is_keyword(keyword, "POINT_DATA") || is_keyword(keyword, "CELL_DATA")) {
            in_point_data_ = is_keyword(keyword, "POINT_DATA");
            vtk_.has_cell_data |= !in_point_data_;
            items_ = count(in_point_data_ ? "points with data" : "cells with data");
            return;
        }
        if (is_keyword(keyword, "METADATA")) { // Up to an empty line.
            line();
            while (!rest_.empty() && !first_word(line()).empty()) {
            }
            return;
        }
        if (is_keyword(keyword, "FIELD"))
            return read_field_data();
        read_attribute(keyword);
    }

    void read_points()
    {
        const std::size_t points = count("points");
        const auto coordinates = numbers<float>(word(), points, 3);
        vtk_.points.resize(coordinates.size() / 3);
        for (std::size_t i = 0; i < vtk_.points.size(); ++i)
            vtk_.points[i] = {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
    }

    void read_cells()
    {
        const std::size_t first = count("cells");
        const std::size_t second = count("numbers of all cells");
        std::vector<std::int64_t> offsets;
        std::vector<std::int64_t> connectivity;
        if (is_version_5_) {
            offsets = block<std::int64_t>("OFFSETS", first);
            connectivity = block<std::int64_t>("CONNECTIVITY", second);
        } else {
            offsets.push_back(0);
            const auto lists = numbers<std::int64_t>("int", second);
            for (std::size_t i = 0; i < lists.size();) {
                const auto size = static_cast<std::size_t>(lists[i]);
                if (size >= lists.size() - i)
                    return fail(fmt::format("cell {} has {} points: the list of cells ends there",
                                            offsets.size() - 1, lists[i]));
                const auto begin = lists.begin() + static_cast<std::ptrdiff_t>(i) + 1;
                connectivity.insert(connectivity.end(), begin, begin + lists[i]);
                offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
                i += size + 1;
            }
            if (offsets.size() - 1 != first)
                return fail(fmt::format("there should be {} cells, but the list has {}", first,
                                        offsets.size() - 1));
        }
        if (vtk_.data_set == VtkDataSet::polygonal_data)
            return;
        const auto size = static_cast<std::int64_t>(connectivity.size());
        if (!std::ranges::is_sorted(offsets) ||
            (!offsets.empty() && (offsets.front() != 0 || offsets.back() != size)))
            return fail("the offsets of the cells do not ascend from 0 to the end of the list");
        vtk_.offsets = std::move(offsets);
        vtk_.connectivity = std::move(connectivity);
    }

    template <class T>
    std::vector<T> block(const char *keyword, std::size_t items)
    {
        if (const std::string_view found = word(); !is_keyword(found, keyword)) {
            fail(found.empty() ? "it ends early"
                               : fmt::format("'{}' stands where {} should", found, keyword));
            return {};
        }
        return numbers<T>(word(), items);
    }

    /// Arrays with names of their own, for points or cells, or for the whole when before both.
    void read_field_data()
    {
        word(); // The name of them all.
        const std::size_t arrays = count("arrays");
        for (std::size_t i = 0; i < arrays && error_.empty(); ++i) {
            std::string_view name = word();
            if (is_keyword(name, "METADATA")) {
                read_section(name);
                name = word();
            }
            const std::size_t components = count("components");
            const std::size_t items = count("values");
            const std::string_view type = word();
            if (is_keyword(type, "STRING"))
                return fail(fmt::format("the array '{}' is of strings", name));
            keep(name, components, numbers<float>(type, items, components));
        }
    }

    void read_attribute(std::string_view keyword)
    {
        const auto named = [&](std::size_t components) {
            const std::string_view name = word();
            keep(name, components, numbers<float>(word(), items_, components));
        };
        if (is_keyword(keyword, "SCALARS"))
            return read_scalars();
        if (is_keyword(keyword, "VECTORS") || is_keyword(keyword, "NORMALS"))
            return named(3);
        if (is_keyword(keyword, "TENSORS"))
            return named(9);
        if (is_keyword(keyword, "TENSORS6"))
            return named(6);
        if (is_keyword(keyword, "GLOBAL_IDS") || is_keyword(keyword, "PEDIGREE_IDS")) {
            word();
            numbers<float>(word(), items_);
            return;
        }
        if (is_keyword(keyword, "TEXTURE_COORDINATES")) {
            word();
            const std::size_t components = count("texture coordinates");
            numbers<float>(word(), items_, components);
            return;
        }
        if (is_keyword(keyword, "COLOR_SCALARS")) {
            word();
            const std::size_t components = count("components");
            numbers<float>(is_binary_ ? "unsigned_char" : "float", items_, components);
            return;
        }
        if (is_keyword(keyword, "LOOKUP_TABLE")) {
            word();
            const std::size_t colors = count("colors");
            numbers<float>(is_binary_ ? "unsigned_char" : "float", colors, 4);
            return;
        }
        fail(fmt::format("'{}' stands where a section should begin", keyword.substr(0, 40)));
    }

    void read_scalars()
    {
        const std::string_view name = word();
        const std::string_view type = word();
        std::size_t components = 1;
        if (const std::string_view rest = rest_; first_word(line()).empty() == false) {
            rest_ = rest;
            components = count("components");
        } else {
            rest_ = rest;
        }
        // The line with the name of a lookup table may be missing.
        const std::string_view before_table = rest_;
        line();
        if (is_keyword(first_word(rest_.substr(0, rest_.find('\n'))), "LOOKUP_TABLE")) {
            word();
            word();
        } else {
            rest_ = before_table;
        }
        keep(name, components, numbers<float>(type, items_, components));
    }

    /// Keeps an array of the points.
    void keep(std::string_view name, std::size_t components, const std::vector<float> &values)
    {
        if (!in_point_data_ || components == 0 || !error_.empty())
            return;
        ScalarField field{decode_name(name), std::vector<float>(values.size() / components)};
        for (std::size_t i = 0; i < field.values.size(); ++i) {
            if (components == 1) {
                field.values[i] = values[i];
                continue;
            }
            double squares = 0.0;
            for (std::size_t c = 0; c < components; ++c)
                squares += std::pow(static_cast<double>(values[i * components + c]), 2.0);
            field.values[i] = static_cast<float>(std::sqrt(squares));
        }
        vtk_.point_fields.push_back(std::move(field));
    }

    std::string_view rest_;
    std::string error_;
    bool is_binary_ = false;
    bool is_version_5_ = false;
    bool in_point_data_ = false;
    std::size_t items_ = 0; ///< Of the points or cells that data follow for.
    LegacyVtk vtk_;
};

} // namespace

Result<LegacyVtk> read_legacy_vtk(const std::filesystem::path &path)
{
    std::error_code code;
    if (!std::filesystem::exists(path, code))
        return Error{"no such file"};
    if (std::filesystem::is_directory(path, code))
        return Error{"it is a directory"};
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return Error{"it cannot be opened"};
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return VtkReader(text).read();
}

} // namespace kb
