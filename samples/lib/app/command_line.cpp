// SPDX-License-Identifier: MIT

#include "lib/app/command_line.hpp"

#include "lib/scene/color.hpp"
#include "lib/version.hpp"

#include <CLI/CLI.hpp>
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

/// Whether all options that are given have a value: an empty one is a variable that was not set.
static Status check_values(const CLI::App &app)
{
    for (const CLI::Option *option : app.get_options()) {
        if (option->get_expected_min() == 0)
            continue; // Flags, and options that may be without a value.
        for (const std::string &value : option->results()) {
            if (value.empty())
                return Error{fmt::format("{}: its value is empty", option->get_name())};
        }
    }
    return ok;
}

std::optional<int> parse_command_line(CLI::App &app, int argc, const char *const *argv)
{
    if (!app.get_option_no_throw("--version"))
        app.set_version_flag("--version",
                             fmt::format("{} (mesa-kbuffer) {}", program_name(app), version));
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForVersion &version_line) {
        fmt::print("{}\n", version_line.what());
        return finish(app);
    } catch (const CLI::CallForHelp &) {
        std::fputs(app.help().c_str(), stdout);
        return finish(app);
    } catch (const CLI::ParseError &error) {
        return fail(app, Error{fmt::format("{} (try --help)", error.what())}, exit_bad_input);
    }
    if (const auto given = check_values(app); !given)
        return fail(app, given.error(), exit_bad_input);
    return std::nullopt;
}

int fail(const CLI::App &app, const Error &error, int status)
{
    std::string line = error.message;
    for (char &c : line)
        c = c == '\n' || c == '\r' ? ' ' : c;
    std::fputs(fmt::format("{}: {}\n", program_name(app), line).c_str(), stderr);
    return status;
}

int finish(const CLI::App &app)
{
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
        return 0;
    return fail(app, Error{"cannot write all that was to be printed to the standard output"},
                exit_unsupported);
}

std::string check_number(const std::string &text, double low, double high)
{
    char *end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && value >= low && value <= high)
        return {};
    return fmt::format("{} is not in the range from {} to {}", text, low, high);
}

/// A decimal number as it is printed: without leading zeros.
static std::optional<int> parse_integer(std::string_view text, int low, int high)
{
    int value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    if (text != std::to_string(value) || value < low || value > high)
        return std::nullopt;
    return value;
}

CLI::Validator integer_in(int low, int high)
{
    const auto check = [low, high](const std::string &text) {
        return parse_integer(text, low, high)
                   ? std::string()
                   : fmt::format("{} is no integer from {} to {}", text, low, high);
    };
    return {check, fmt::format("INT in [{} - {}]", low, high)};
}

static constexpr int max_side = 8192;

CLI::Option *add_size_option(CLI::App &app, Size &size)
{
    const auto parse = [&size](const std::string &text) {
        const auto cross = text.find('x');
        if (cross == std::string::npos)
            return false;
        const auto width = parse_integer(std::string_view(text).substr(0, cross), 1, max_side);
        const auto height = parse_integer(std::string_view(text).substr(cross + 1), 1, max_side);
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
                    throw CLI::ValidationError(
                        "--size", fmt::format("{} is not WxH with 1 to {} each", text, max_side));
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

CLI::Option *add_color_option(CLI::App &app, const std::string &name,
                              const std::function<void(glm::vec3)> &set, const std::string &help)
{
    return app
        .add_option_function<std::string>(
            name,
            [name, set](const std::string &text) {
                const auto color = parse_color(text);
                if (!color)
                    throw CLI::ValidationError(name, color.error().message);
                set(*color);
            },
            help)
        ->type_name(color_forms);
}

CLI::Option *add_background_option(CLI::App &app, glm::vec3 &background)
{
    return add_color_option(
               app, "--background", [&background](glm::vec3 color) { background = color; },
               "Color behind everything")
        ->default_str(fmt::format("{},{},{}", background.r, background.g, background.b));
}

CLI::Option *add_json_option(CLI::App &app, std::filesystem::path &file)
{
    return app.add_option("--json", file, "Write what was drawn and the times of each frame")
        ->type_name("FILE.json");
}

CLI::Option *add_context_option(CLI::App &app, std::string &kind)
{
    return app
        .add_option(
            "--context", kind,
            "osmesa (in memory), egl (surfaceless) or glfw (a window: drag with the left button "
            "or use the arrow keys to turn, the wheel to come nearer, Escape to close)")
        ->check(CLI::IsMember({"osmesa", "egl", "glfw"}))
        ->type_name("KIND")
        ->capture_default_str();
}

} // namespace kb
