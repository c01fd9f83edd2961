// SPDX-License-Identifier: MIT
//
// What all command lines have in common: bad usage and bad input give one line on the standard
// error output and exit status 2; what the machine or driver lacks gives one line and 1.

#pragma once

#include "lib/result.hpp"
#include "lib/scene/camera.hpp"

#include <glm/vec3.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

// CLI11's header takes longer to compile than most files that only pass options on: who declares or
// parses options includes it.
namespace CLI
{
class App;
class Option;
class Validator;
} // namespace CLI

namespace kb
{

inline constexpr int exit_unsupported = 1;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_interrupted = 130; ///< By Ctrl-C, as shells say it.

/// The exit status with which the program ends now, if it does: after --help, --version or bad
/// usage.
std::optional<int> parse_command_line(CLI::App &app, int argc, const char *const *argv);

/// Prints "program: message" on the standard error output; returns the status.
int fail(const CLI::App &app, const Error &error, int status);

/// The exit status of a program that has done its work: 0 if what it printed has arrived.
int finish(const CLI::App &app);

/// A check for add_option: empty, or what is wrong. Unlike CLI::Range it refuses NaN.
std::string check_number(const std::string &text, double low, double high);

/// A check for add_option. Unlike CLI::Range it refuses what CLI11 would take for octal (010) and
/// hexadecimal numbers.
CLI::Validator integer_in(int low, int high);

/// --size WxH, each side from 1 to 8192.
CLI::Option *add_size_option(CLI::App &app, Size &size);

/// --azimuth and --elevation of a camera that turns about the scene.
void add_turning_options(CLI::App &app, OrbitCamera &camera);

/// Those, --distance and --field-of-view.
void add_camera_options(CLI::App &app, OrbitCamera &camera);

/// An option whose value parse_color reads.
CLI::Option *add_color_option(CLI::App &app, const std::string &name,
                              const std::function<void(glm::vec3)> &set, const std::string &help);

/// --background COLOR
CLI::Option *add_background_option(CLI::App &app, glm::vec3 &background);

/// --json FILE.json
CLI::Option *add_json_option(CLI::App &app, std::filesystem::path &file);

/// --context osmesa|egl|glfw
CLI::Option *add_context_option(CLI::App &app, std::string &kind);

} // namespace kb
