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
