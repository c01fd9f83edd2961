// SPDX-License-Identifier: MIT
//
// Wavefront OBJ: a statement a line, and libraries of materials (MTL) in files of their own.

#include "lib/io/file.hpp"
#include "lib/io/mesh_file.hpp"
#include "lib/io/polygon.hpp"
#include "lib/io/text_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

namespace kb
{

namespace
{

/// The words of a statement; a backslash at a line's end continues it.
class Statements
{
public:
    explicit Statements(std::string_view text) : text_(text) {}

    /// Goes on to the next statement that says something.
    bool next()
    {
        do {
            if (!read())
                return false;
            keyword_ = take_word(rest_);
        } while (keyword_.empty());
        return true;
    }

    std::string_view keyword() const { return keyword_; }
    std::string_view rest() const { return trim(rest_); }
    std::size_t line() const { return line_; }

    /// All further words.
    std::vector<std::string_view> words() const
    {
        std::vector<std::string_view> words;
        std::string_view rest = rest_;
        for (auto word = take_word(rest); !word.empty(); word = take_word(rest))
            words.push_back(word);
        return words;
    }

private:
    bool read()
    {
        auto line = take_line(text_);
        if (!line)
            return false;
        ++line_;
        rest_ = *line;
        if (rest_.ends_with('\\')) {
            joined_.clear();
            while (line && line->ends_with('\\')) {
                joined_.append(line->substr(0, line->size() - 1)).append(" ");
                line = take_line(text_);
                line_ += line.has_value();
            }
            joined_.append(line.value_or(""));
            rest_ = joined_;
        }
        rest_ = rest_.substr(0, rest_.find('#'));
        return true;
    }

    std::string_view text_;
    std::string joined_;
    std::string_view rest_;
    std::string_view keyword_;
    std::size_t line_ = 0;
};

Result<std::vector<double>> parse_numbers(const std::vector<std::string_view> &words)
{
    std::vector<double> numbers;
    for (const std::string_view word : words) {
        const auto number = parse_number(word);
        if (!number)
            return Error{fmt::format("'{}' is no number", word.substr(0, 40))};
        numbers.push_back(*number);
    }
    return numbers;
}

struct Material {
    glm::vec3 color = glm::vec3(1.0F);
    std::optional<float> opacity;      ///< d
    std::optional<float> transparency; ///< Tr, which counts where there is no d.

    glm::vec4 rgba() const { return {color, opacity.value_or(1.0F - transparency.value_or(0.0F))}; }
};

using Materials = std::map<std::string, Material, std::less<>>;

/// One statement of a material library.
Status read_material_statement(const Statements &statement, Materials &materials,
                               Material *&current, std::set<std::string> &left_out)
{
    const std::string_view keyword = statement.keyword();
    if (keyword == "newmtl") {
        current = &(materials[std::string(statement.rest())] = {});
        return ok;
    }
    if (keyword.starts_with("map_Kd") || keyword.starts_with("map_d"))
        left_out.insert("textures");
    if (keyword != "Kd" && keyword != "d" && keyword != "Tr")
        return ok;
    if (!current)
        return Error{fmt::format("{} comes before the first newmtl", keyword)};

    auto words = statement.words();
    if (keyword == "Kd" && !words.empty() && (words[0] == "spectral" || words[0] == "xyz")) {
        left_out.insert(fmt::format("colors by {}", words[0]));
        return ok;
    }
    if (keyword == "d" && !words.empty() && words[0] == "-halo") {
        left_out.insert("halos");
        words.erase(words.begin());
    }
    const auto numbers = parse_numbers(words);
    if (!numbers)
        return numbers.error();
    if (!std::all_of(numbers->begin(), numbers->end(),
                     [](double number) { return number >= 0.0 && number <= 1.0; }))
        return Error{fmt::format("{} is not from 0 to 1", keyword)};
    const auto number = [&](std::size_t i) { return static_cast<float>((*numbers)[i]); };
    if (keyword == "Kd" && numbers->size() == 3)
        current->color = {number(0), number(1), number(2)};
    else if (keyword == "Kd" && numbers->size() == 1)
        current->color = glm::vec3(number(0));
    else if (keyword != "Kd" && numbers->size() == 1)
        (keyword == "d" ? current->opacity : current->transparency) = number(0);
    else
        return Error{fmt::format("{} has {} numbers", keyword, numbers->size())};
    return ok;
}

Status read_materials(std::string_view content, Materials &materials,
                      std::set<std::string> &left_out)
{
    Material *current = nullptr;
    Statements statements(content);
    while (statements.next()) {
        if (auto read = read_material_statement(statements, materials, current, left_out); !read)
            return Error{fmt::format("line {}: {}", statements.line(), read.error().message)};
    }
    return ok;
}

/// What a corner of a face is made of: numbers from 0; `none` where there is none.
constexpr std::uint32_t none = ~0U;
using Corner = std::array<std::uint32_t, 3>; ///< Position, normal, color.

struct CornerHash {
    std::size_t operator()(const Corner &corner) const
    {
        std::uint64_t hash = 0;
        for (const std::uint32_t word : corner)
            hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
        return static_cast<std::size_t>(hash ^ hash >> 32U);
    }
};

class Reader
{
public:
    explicit Reader(const std::filesystem::path &directory) : directory_(directory) {}

    Status read(std::string_view content)
    {
        Statements statements(content);
        while (statements.next()) {
            if (auto read = read_statement(statements); !read)
                return Error{fmt::format("line {}: {}", statements.line(), read.error().message)};
        }
        return ok;
    }

    FileMesh finish() &&
    {
        mesh_.format = "OBJ";
        mesh_.positions = std::move(corner_positions_);
        if (normals_.empty())
            mesh_.normals.clear();
        if (!has_vertex_colors_ && !has_materials_)
            mesh_.colors.clear();
        else
            mesh_.colors_of = has_vertex_colors_ ? "vertices" : "materials";
        mesh_.notes.assign(notes_.begin(), notes_.end());
        for (const std::string &what : left_out_)
            mesh_.notes.push_back(what + " are left out");
        return std::move(mesh_);
    }

private:
    Status read_statement(const Statements &statement)
    {
        const std::string_view keyword = statement.keyword();
        if (keyword == "v")
            return read_vertex(statement.words());
        if (keyword == "vn")
            return read_normal(statement.words());
        if (keyword == "f" || keyword == "fo")
            return read_face(statement.words());
        if (keyword == "usemtl") {
            use_material(statement.rest());
            return ok;
        }
        if (keyword == "mtllib")
            return read_libraries(statement);
        static const std::set<std::string_view> without_triangles{"p", "l"};
        static const std::set<std::string_view> free_form{"curv", "curv2", "surf", "bzp",
                                                          "bsp",  "cdc",   "cdp",  "res"};
        // Names, smoothing, what belongs to textures and to free forms, and how others render.
        static const std::set<std::string_view> without_effect{
            "g",         "o",     "s",        "mg",       "vt",   "vp",     "cstype", "deg",
            "bmat",      "step",  "parm",     "trim",     "hole", "scrv",   "sp",     "end",
            "con",       "bevel", "c_interp", "d_interp", "lod",  "maplib", "usemap", "shadow_obj",
            "trace_obj", "ctech", "stech",    "call",     "csh"};
        if (without_triangles.contains(keyword))
            left_out_.insert(keyword == "p" ? "points" : "lines");
        else if (free_form.contains(keyword))
            left_out_.insert("free-form curves and surfaces");
        else if (!without_effect.contains(keyword))
            return Error{fmt::format("no such statement: '{}'", keyword.substr(0, 40))};
        if (keyword == "call")
            left_out_.insert("other files that it calls");
        return ok;
    }

    /// Coordinates, perhaps a weight (of free forms), perhaps a color.
    Status read_vertex(const std::vector<std::string_view> &words)
    {
        const auto numbers = parse_numbers(words);
        if (!numbers)
            return numbers.error();
        const std::size_t count = numbers->size();
        if (count != 3 && count != 4 && count != 6 && count != 7)
            return Error{fmt::format("a vertex of {} numbers", count)};
        const auto &n = *numbers;
        positions_.emplace_back(n[0], n[1], n[2]);
        if (count >= 6) {
            has_vertex_colors_ = true;
            vertex_colors_.resize(positions_.size() - 1, glm::vec3(1.0F));
            vertex_colors_.emplace_back(n[count - 3], n[count - 2], n[count - 1]);
        }
        return ok;
    }

    Status read_normal(const std::vector<std::string_view> &words)
    {
        const auto numbers = parse_numbers(words);
        if (!numbers)
            return numbers.error();
        if (numbers->size() != 3)
            return Error{fmt::format("a normal of {} numbers", numbers->size())};
        normals_.emplace_back((*numbers)[0], (*numbers)[1], (*numbers)[2]);
        return ok;
    }

    /// From an index of the file, from 1, or from -1 backwards, to one from 0.
    static Result<std::uint32_t> resolve(std::string_view word, std::size_t count, const char *what)
    {
        const auto index = parse_integer(word);
        if (!index)
            return Error{fmt::format("'{}' is no index", word.substr(0, 40))};
        const auto signed_count = static_cast<std::int64_t>(count);
        const std::int64_t place = *index < 0 ? signed_count + *index : *index - 1;
        if (*index == 0 || place < 0 || place >= signed_count || place >= none)
            return Error{fmt::format("{} {} is used, but there are {}", what, *index, count)};
        return static_cast<std::uint32_t>(place);
    }

    /// position, position/texture, position//normal or position/texture/normal
    Result<Corner> parse_corner(std::string_view word) const
    {
        std::array<std::string_view, 3> parts;
        const std::string_view whole = word;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto slash = word.find('/');
            parts.at(i) = word.substr(0, slash);
            if (slash == std::string_view::npos)
                break;
            word.remove_prefix(slash + 1);
            if (i == 2)
                return Error{fmt::format("'{}' is no corner of a face", whole.substr(0, 40))};
        }
        const auto position = resolve(parts[0], positions_.size(), "vertex");
        if (!position)
            return position.error();
        Corner corner{*position, none, color_};
        if (!parts[2].empty()) {
            const auto normal = resolve(parts[2], normals_.size(), "normal");
            if (!normal)
                return normal.error();
            corner[1] = *normal;
        }
        return corner;
    }

    Result<std::uint32_t> vertex_of(const Corner &corner)
    {
        const auto next = static_cast<std::uint32_t>(corner_positions_.size());
        const auto [known, is_new] = vertices_.try_emplace(corner, next);
        if (!is_new)
            return known->second;
        if (next == none)
            return Error{"there are too many vertices"};
        corner_positions_.push_back(positions_[corner[0]]);
        mesh_.normals.push_back(corner[1] == none ? glm::vec3(0.0F) : normals_[corner[1]]);
        glm::vec4 color = corner[2] == none ? glm::vec4(1.0F) : colors_[corner[2]];
        if (corner[0] < vertex_colors_.size())
            color = glm::vec4(vertex_colors_[corner[0]], color.a);
        mesh_.colors.push_back(color);
        return next;
    }

    Status read_face(const std::vector<std::string_view> &words)
    {
        if (words.size() < 3)
            return Error{fmt::format("a face of {} corners", words.size())};
        std::vector<std::uint32_t> corners;
        for (const std::string_view word : words) {
            const auto corner = parse_corner(word);
            if (!corner)
                return corner.error();
            const auto vertex = vertex_of(*corner);
            if (!vertex)
                return vertex.error();
            corners.push_back(*vertex);
        }
        triangulate(corner_positions_, corners, mesh_.indices);
        return ok;
    }

    void use_material(std::string_view name)
    {
        const auto material = materials_.find(name);
        color_ = none;
        if (material == materials_.end()) {
            // A library that is missing has a note of its own.
            if (has_library_)
                notes_.insert(fmt::format("its material '{}' is in no library", name));
            return;
        }
        has_materials_ = true;
        const auto next = static_cast<std::uint32_t>(colors_.size());
        const auto [used, is_new] = used_materials_.try_emplace(material->first, next);
        if (is_new)
            colors_.push_back(material->second.rgba());
        color_ = used->second;
    }

    /// A line names one library or several. Names with blanks are seen.
    Status read_libraries(const Statements &statement)
    {
        if (std::filesystem::exists(path_of(statement.rest())))
            return read_library(statement.rest());
        for (const std::string_view name : statement.words()) {
            if (auto read = read_library(name); !read)
                return read;
        }
        return ok;
    }

    std::filesystem::path path_of(std::string_view name) const
    {
        std::string path(name);
        std::replace(path.begin(), path.end(), '\\', '/');
        return directory_ / path;
    }

    Status read_library(std::string_view name)
    {
        const auto content = read_file(path_of(name));
        if (!content) {
            notes_.insert(fmt::format("its material library {} is left out: {}", name,
                                      content.error().message));
            return ok;
        }
        has_library_ = true;
        if (auto read = read_materials(*content, materials_, left_out_); !read)
            return Error{fmt::format("{}: {}", name, read.error().message)};
        return ok;
    }

    std::filesystem::path directory_;
    std::vector<glm::dvec3> positions_;
    std::vector<glm::vec3> vertex_colors_; ///< Of the first vertices, as many as there are.
    std::vector<glm::vec3> normals_;
    Materials materials_;
    std::map<std::string, std::uint32_t> used_materials_; ///< Where their colors are.
    std::vector<glm::vec4> colors_;
    std::uint32_t color_ = none; ///< Of the next faces, in `colors_`.
    std::unordered_map<Corner, std::uint32_t, CornerHash> vertices_;
    std::vector<glm::dvec3> corner_positions_; ///< Of the vertices of the mesh.
    bool has_vertex_colors_ = false;
    bool has_materials_ = false;
    bool has_library_ = false;
    std::set<std::string> left_out_; ///< Plural nouns.
    std::set<std::string> notes_;
    FileMesh mesh_;
};

} // namespace

Result<FileMesh> read_obj(std::string_view content, const std::filesystem::path &directory)
{
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (content.starts_with(byte_order_mark))
        content.remove_prefix(byte_order_mark.size());
    Reader reader(directory);
    if (auto read = reader.read(content); !read)
        return read.error();
    return std::move(reader).finish();
}

} // namespace kb
