// SPDX-License-Identifier: MIT

#include "bench/options.hpp"

#include "bench/methods.hpp"
#include "bench/study_scene.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>

namespace kb::bench
{

template <class T>
static void drop_repeats(std::vector<T> &values)
{
    std::vector<T> kept;
    for (const T &value : values)
        if (std::ranges::find(kept, value) == kept.end())
            kept.push_back(value);
    values = std::move(kept);
}

static std::string joined(const std::vector<std::string> &names)
{
    return fmt::format("{}", fmt::join(names, ","));
}

/// CLI11's own check of this kind repeats the names in the help text.
static CLI::Validator one_of(const std::vector<std::string> &names)
{
    return CLI::IsMember(names).description("");
}

std::optional<int> parse_options(CLI::App &app, Options &options, int argc, const char *const *argv)
{
    std::vector<std::string> all_scenes;
    for (const SceneEntry &scene : scenes)
        all_scenes.emplace_back(scene.name);
    std::vector<std::string> all_methods;
    for (const Method &method : methods)
        all_methods.emplace_back(method.name);
    options.scenes = all_scenes;
    options.methods = all_methods;

    app.add_option("--scenes", options.scenes, "Scenes to draw")
        ->delimiter(',')
        ->check(one_of(all_scenes))
        ->type_name("NAME,...")
        ->default_str(joined(all_scenes));
    app.add_option("--methods", options.methods,
                   "Methods to measure; zbuffer always is, as the base of the ratios")
        ->delimiter(',')
        ->check(one_of(all_methods))
        ->type_name("NAME,...")
        ->default_str(joined(all_methods));
    auto *ks =
        app.add_option("--k", options.ks,
                       "Fragments kept of a pixel, 1 to 64 each (fbfetch: to 16); by default those "
                       "that suit the scene, of 4, 8, 16 and 64")
            ->delimiter(',')
            ->check(kb::integer_in(1, max_k).description(""))
            ->type_name("K,...");
    auto *rounds = app.add_option("--rounds", options.rounds, "Frames measured of each method")
                       ->check(kb::integer_in(1, 100000).description(""))
                       ->type_name("N")
                       ->capture_default_str();
    auto *size = add_size_option(app, options.size);
    const auto path_option = [&app](const char *name, std::filesystem::path &path,
                                    const char *about) {
        return app.add_option(name, path, about)->type_name("PATH")->default_str(path.string());
    };
    path_option("--stock", options.stock, "Prefix of stock Mesa");
    path_option("--ours", options.ours, "Prefix of the patched Mesa");
    path_option("--dragon", options.dragon, "The dragon's mesh; without it, a generated one")
        ->check(CLI::ExistingFile.description(""));
    path_option("--out", options.out, "File for the results");
    path_option("--pictures", options.pictures, "Folder for a picture of each scene and method");
    app.add_flag("--quick", options.quick, "A smoke run: 3 rounds of k = 4 at 256x256");
    app.add_option("--commit", options.commit, "The project's commit, for the record")
        ->type_name("NAME");
    app.add_flag("--worker", options.worker)->group(""); // Not for users.

    if (const auto status = parse_command_line(app, argc, argv))
        return status;
    if (options.quick) {
        if (ks->empty())
            options.ks = {4};
        if (rounds->empty())
            options.rounds = 3;
        if (size->empty())
            options.size = {256, 256};
    }
    drop_repeats(options.scenes);
    drop_repeats(options.ks);
    return std::nullopt;
}

} // namespace kb::bench
