// SPDX-License-Identifier: MIT

#include "tests/reference/scene.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>

namespace kb::reference
{

namespace
{

using nlohmann::ordered_json;

template <class Enum>
struct Name {
    Enum value;
    std::string_view name;
};

constexpr std::array<Name<Extension>, 2> extension_names{
    {{Extension::peeling, "peeling"}, {Extension::program, "program"}}};
constexpr std::array<Name<Func>, 4> func_names{{{Func::less, "less"},
                                                {Func::lequal, "lequal"},
                                                {Func::greater, "greater"},
                                                {Func::gequal, "gequal"}}};
constexpr std::array<Name<DepthFormat>, 3> depth_names{
    {{DepthFormat::d32f, "32f"}, {DepthFormat::d24, "24"}, {DepthFormat::d16, "16"}}};
constexpr std::array<Name<ColorFormat>, 6> color_names{{{ColorFormat::rgba32f, "rgba32f"},
                                                        {ColorFormat::rgba16f, "rgba16f"},
                                                        {ColorFormat::rgba8, "rgba8"},
                                                        {ColorFormat::rgb10_a2, "rgb10_a2"},
                                                        {ColorFormat::r8, "r8"},
                                                        {ColorFormat::r32ui, "r32ui"}}};
constexpr std::array<Name<Cull>, 3> cull_names{
    {{Cull::none, "none"}, {Cull::front, "front"}, {Cull::back, "back"}}};
constexpr std::array<Name<EntryLayout>, 4> layout_names{{{EntryLayout::rgbz, "rgbz"},
                                                         {EntryLayout::packed, "packed"},
                                                         {EntryLayout::depth, "depth"},
                                                         {EntryLayout::depth4, "depth4"}}};

template <class Enum, std::size_t n>
std::string_view name(const std::array<Name<Enum>, n> &names, Enum value)
{
    return std::find_if(names.begin(), names.end(), [=](auto &e) { return e.value == value; })
        ->name;
}

template <class Enum, std::size_t n>
Enum value(const std::array<Name<Enum>, n> &names, const ordered_json &json)
{
    const auto text = json.get<std::string>();
    for (const auto &entry : names) {
        if (entry.name == text)
            return entry.value;
    }
    throw std::runtime_error(fmt::format("no such name: {}", text));
}

ordered_json json_of(const Box &box)
{
    return {box.x, box.y, box.width, box.height};
}

Box box_of(const ordered_json &json)
{
    const auto numbers = json.get<std::array<int, 4>>();
    return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

ordered_json json_of(const Triangle &triangle)
{
    ordered_json json{{"id", triangle.id}};
    for (const Vertex &vertex : triangle.vertices)
        json["vertices"].push_back({{"position", vertex.position}, {"color", vertex.color}});
    return json;
}

Triangle triangle_of(const ordered_json &json)
{
    Triangle triangle{json.at("id").get<std::uint32_t>(), {}};
    const ordered_json &vertices = json.at("vertices");
    if (vertices.size() != 3)
        throw std::runtime_error("a triangle has not three vertices");
    for (std::size_t i = 0; i < 3; ++i)
        triangle.vertices[i] = {vertices[i].at("position").get<std::array<float, 4>>(),
                                vertices[i].at("color").get<std::array<float, 4>>()};
    return triangle;
}

ordered_json json_of(const Step &step)
{
    ordered_json json{{"command", step.clear ? "clear" : "draw"}};
    if (step.scissor)
        json["scissor"] = json_of(*step.scissor);
    if (step.clear)
        return json;
    json["depth_mask"] = step.depth_mask;
    json["cull"] = name(cull_names, step.cull);
    json["triangles"] = ordered_json::array();
    for (const Triangle &triangle : step.triangles)
        json["triangles"].push_back(json_of(triangle));
    return json;
}

Step step_of(const ordered_json &json)
{
    Step step;
    const auto command = json.at("command").get<std::string>();
    if (command != "clear" && command != "draw")
        throw std::runtime_error(fmt::format("no such command: {}", command));
    step.clear = command == "clear";
    if (json.contains("scissor"))
        step.scissor = box_of(json["scissor"]);
    if (step.clear)
        return step;
    step.depth_mask = json.at("depth_mask").get<bool>();
    step.cull = value(cull_names, json.at("cull"));
    for (const ordered_json &triangle : json.at("triangles"))
        step.triangles.push_back(triangle_of(triangle));
    return step;
}

Scene scene_of(const ordered_json &json)
{
    Scene scene;
    scene.extension = value(extension_names, json.at("extension"));
    const auto size = json.at("size").get<std::array<int, 2>>();
    scene.width = size[0];
    scene.height = size[1];
    scene.samples = json.at("samples").get<int>();
    scene.k = json.at("k").get<int>();
    if (scene.extension == Extension::peeling) {
        scene.func = value(func_names, json.at("func"));
        scene.depth_format = value(depth_names, json.at("depth_format"));
        scene.color_formats.clear();
        for (const ordered_json &format : json.at("color_formats"))
            scene.color_formats.push_back(value(color_names, format));
        scene.all_passes = json.at("all_passes").get<bool>();
        scene.clear_depth = json.at("clear_depth").get<float>();
    } else {
        scene.layout = value(layout_names, json.at("layout"));
    }
    scene.flat = json.at("flat").get<bool>();
    scene.color_mask = json.at("color_mask").get<std::array<bool, 4>>();
    scene.viewport = box_of(json.at("viewport"));
    scene.depth_range = json.at("depth_range").get<std::array<double, 2>>();
    scene.zero_to_one = json.at("zero_to_one").get<bool>();
    for (const ordered_json &step : json.at("steps"))
        scene.steps.push_back(step_of(step));
    return scene;
}

Status check_triangle(const Triangle &triangle)
{
    for (const Vertex &vertex : triangle.vertices) {
        for (const float number : vertex.position) {
            if (!std::isfinite(number))
                return Error{fmt::format("triangle {}: a coordinate is not finite", triangle.id)};
        }
        for (const float channel : vertex.color) {
            if (!(channel >= 0.0F && channel <= 1.0F))
                return Error{fmt::format("triangle {}: a color is not in [0, 1]", triangle.id)};
        }
    }
    if (triangle.id >= 1U << 24U)
        return Error{fmt::format("triangle {}: the id has more than 24 bits", triangle.id)};
    return ok;
}

} // namespace

std::size_t Scene::triangle_count() const
{
    std::size_t count = 0;
    for (const Step &step : steps)
        count += step.triangles.size();
    return count;
}

bool Scene::has_clears() const
{
    return std::any_of(steps.begin(), steps.end(), [](const Step &step) { return step.clear; });
}

Status check_scene(const Scene &scene)
{
    if (scene.width < 1 || scene.height < 1 || scene.width > 512 || scene.height > 512)
        return Error{fmt::format("the size is {}x{}, but 1x1 to 512x512 are possible", scene.width,
                                 scene.height)};
    if (scene.samples != 0 && scene.samples != 4)
        return Error{fmt::format("{} samples, but 0 and 4 are possible", scene.samples)};
    const auto triangles = static_cast<int>(scene.triangle_count());
    if (scene.samples * scene.height * std::max(scene.k, triangles) > 16384)
        return Error{"the samples of all layers are more than a texture has room for"};
    const int most = scene.extension == Extension::peeling ? 256 : max_fragments(scene.layout);
    if (scene.k < 1 || scene.k > most)
        return Error{fmt::format("k is {}, but 1 to {} are possible", scene.k, most)};
    if (scene.color_formats.size() > 4)
        return Error{"more than four color attachments"};
    if (scene.all_passes && scene.has_clears())
        return Error{"clears between draws make ranks of several passes meaningless"};
    if (scene.all_passes && (scene.func == Func::lequal || scene.func == Func::gequal))
        return Error{"several passes need the function less or greater"};
    const bool masked =
        !std::all_of(scene.color_mask.begin(), scene.color_mask.end(), [](bool on) { return on; });
    if (masked && scene.extension == Extension::program &&
        (scene.layout != EntryLayout::rgbz || !scene.color_mask[3]))
        return Error{"a color mask would take apart what the program keeps"};
    if (scene.viewport.width < 1 || scene.viewport.height < 1)
        return Error{"the viewport is empty"};
    for (const double depth :
         {scene.depth_range[0], scene.depth_range[1], static_cast<double>(scene.clear_depth)}) {
        if (!(depth >= 0.0 && depth <= 1.0))
            return Error{fmt::format("a depth of {} is not in [0, 1]", depth)};
    }
    for (const Step &step : scene.steps) {
        if (step.scissor && (step.scissor->width < 0 || step.scissor->height < 0))
            return Error{"the scissor box is negative"};
        for (const Triangle &triangle : step.triangles) {
            if (auto checked = check_triangle(triangle); !checked)
                return checked;
        }
    }
    return ok;
}

std::string to_json(const Scene &scene)
{
    ordered_json json{{"extension", name(extension_names, scene.extension)},
                      {"size", {scene.width, scene.height}},
                      {"samples", scene.samples},
                      {"k", scene.k}};
    if (scene.extension == Extension::peeling) {
        json["func"] = name(func_names, scene.func);
        json["depth_format"] = name(depth_names, scene.depth_format);
        json["color_formats"] = ordered_json::array();
        for (const ColorFormat format : scene.color_formats)
            json["color_formats"].push_back(name(color_names, format));
        json["all_passes"] = scene.all_passes;
        json["clear_depth"] = scene.clear_depth;
    } else {
        json["layout"] = name(layout_names, scene.layout);
    }
    json["flat"] = scene.flat;
    json["color_mask"] = scene.color_mask;
    json["viewport"] = json_of(scene.viewport);
    json["depth_range"] = scene.depth_range;
    json["zero_to_one"] = scene.zero_to_one;
    json["steps"] = ordered_json::array();
    for (const Step &step : scene.steps)
        json["steps"].push_back(json_of(step));
    return json.dump(1);
}

Result<Scene> from_json(const std::string &text)
{
    Scene scene;
    try {
        scene = scene_of(ordered_json::parse(text));
    } catch (const std::exception &error) {
        return Error{fmt::format("not a scene: {}", error.what())};
    }
    if (auto checked = check_scene(scene); !checked)
        return Error{fmt::format("not a scene: {}", checked.error().message)};
    return scene;
}

Result<Scene> load_scene(const std::filesystem::path &path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return Error{fmt::format("cannot read {}", path.string())};
    auto scene = from_json({std::istreambuf_iterator<char>(file), {}});
    if (!scene)
        return Error{fmt::format("{}: {}", path.string(), scene.error().message)};
    return scene;
}

} // namespace kb::reference
