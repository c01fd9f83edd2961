// SPDX-License-Identifier: MIT

#include "command_line.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>

namespace kb
{

/// The name to put before messages: the last part of argv[0] or the one the app was given.
static std::string program_name(const CLI::App &app)
{
    return app.get_name().empty() ? "error" : app.get_name();
}

std::optional<int> parse_command_line(CLI::App &app, int argc, const char *const *argv)
{
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp &) {
        fmt::print("{}", app.help());
        return 0;
    } catch (const CLI::ParseError &error) {
        return fail(app, Error{fmt::format("{} (try --help)", error.what())}, exit_bad_input);
    }
    return std::nullopt;
}

int fail(const CLI::App &app, const Error &error, int status)
{
    std::string line = error.message;
    for (char &c : line)
        c = c == '\n' || c == '\r' ? ' ' : c;
    fmt::print(stderr, "{}: {}\n", program_name(app), line);
    return status;
}

std::string check_number(const std::string &text, double low, double high)
{
    char *end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && value >= low && value <= high)
        return {};
    return fmt::format("{} is not in the range from {} to {}", text, low, high);
}

static std::optional<int> parse_side(std::string_view text)
{
    int side = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), side);
    if (code != std::errc() || end != text.data() + text.size() || side < 1 || side > 8192)
        return std::nullopt;
    return side;
}

CLI::Option *add_size_option(CLI::App &app, Size &size)
{
    const auto parse = [&size](const std::string &text) {
        const auto cross = text.find('x');
        if (cross == std::string::npos)
            return false;
        const auto width = parse_side(std::string_view(text).substr(0, cross));
        const auto height = parse_side(std::string_view(text).substr(cross + 1));
        if (!width || !height)
            return false;
        size = {*width, *height};
        return true;
    };
    return app
        .add_option_function<std::string>(
            "--size",
            [parse](const std::string &text) {
                if (!parse(text))
                    throw CLI::ValidationError("--size", text + " is not WxH with 1 to 8192 each");
            },
            "Size of the picture in pixels")
        ->type_name("WxH")
        ->default_str(fmt::format("{}x{}", size.width, size.height));
}

static void add_number_option(CLI::App &app, const char *name, float &value, double low,
                              double high, const char *type, const char *help)
{
    app.add_option(name, value, help)
        ->check([=](const std::string &text) { return check_number(text, low, high); })
        ->type_name(type)
        ->capture_default_str();
}

void add_turning_options(CLI::App &app, OrbitCamera &camera)
{
    add_number_option(app, "--azimuth", camera.azimuth, -360.0, 360.0, "DEG",
                      "Degrees about the vertical axis");
    add_number_option(app, "--elevation", camera.elevation, -90.0, 90.0, "DEG",
                      "Degrees from above");
}

void add_camera_options(CLI::App &app, OrbitCamera &camera)
{
    add_turning_options(app, camera);
    add_number_option(app, "--distance", camera.distance, 0.0, 20.0, "LENGTH",
                      "Of the eye from the middle of the scene, which has radius 1");
    add_number_option(app, "--field-of-view", camera.field_of_view, 1.0, 120.0, "DEG",
                      "Of the shorter side of the picture");
}

CLI::Option *add_background_option(CLI::App &app, glm::vec3 &background)
{
    const auto set = [&background](const std::vector<float> &c) {
        background = glm::vec3(c[0], c[1], c[2]);
    };
    return app
        .add_option_function<std::vector<float>>("--background", set,
                                                 "Red, green and blue from 0 to 1")
        ->expected(3)
        ->delimiter(',')
        ->check([](const std::string &text) { return check_number(text, 0.0, 1.0); })
        ->type_name("R,G,B")
        ->default_str(fmt::format("{},{},{}", background.r, background.g, background.b));
}

CLI::Option *add_context_option(CLI::App &app, std::string &kind)
{
    return app
        .add_option("--context", kind,
                    "osmesa (in memory), egl (surfaceless) or glfw (a window with orbit camera)")
        ->check(CLI::IsMember({"osmesa", "egl", "glfw"}))
        ->type_name("KIND")
        ->capture_default_str();
}

} // namespace kb
