// SPDX-License-Identifier: MIT

#include "peeling/options.hpp"

#include <CLI/CLI.hpp>
#include <map>
#include <vector>

namespace kb
{

using Words = std::map<std::string, GLenum>;

static const Words funcs{
    {"less", GL_LESS}, {"lequal", GL_LEQUAL}, {"greater", GL_GREATER}, {"gequal", GL_GEQUAL}};
static const Words depth_formats{
    {"32f", GL_DEPTH_COMPONENT32F}, {"24", GL_DEPTH_COMPONENT24}, {"16", GL_DEPTH_COMPONENT16}};
static const Words color_formats{{"8", GL_RGBA8}, {"16f", GL_RGBA16F}, {"32f", GL_RGBA32F}};

std::string word_of(GLenum value)
{
    for (const Words &words : {funcs, depth_formats, color_formats}) {
        for (const auto &[word, meaning] : words) {
            if (meaning == value)
                return word;
        }
    }
    return "";
}

/// An option whose words stand for GL values.
static void add_words(CLI::App &app, const char *name, GLenum &value, const Words &words,
                      const char *default_word, const char *help)
{
    std::vector<std::string> names;
    for (const auto &word : words)
        names.push_back(word.first);
    app.add_option_function<std::string>(
           name, [&value, words](const std::string &word) { value = words.at(word); }, help)
        ->check(CLI::IsMember(names))
        ->type_name("NAME")
        ->default_str(default_word);
}

void declare_options(CLI::App &app, PeelingOptions &options)
{
    add_scene_options(app, options.scene);
    app.add_option("--k", options.layers.count, "Layers that a pass fills (the drivers have 256)")
        ->check(integer_in(1, 2048))
        ->type_name("N")
        ->capture_default_str();
    app.add_flag("--all", options.all,
                 "Draw passes until there is no further layer: an A-buffer in the memory of k");
    add_words(
        app, "--func", options.layers.func, funcs, "less",
        "less, lequal (nearest first), greater or gequal (farthest first); of equal depths less "
        "and greater keep the order of drawing, the others reverse it");
    add_words(app, "--depth-format", options.layers.depth_format, depth_formats, "32f",
              "Depths are compared as stored in 32f, 24 or 16 bits");
    add_words(app, "--color-format", options.layers.color_formats.front(), color_formats, "8",
              "RGBA colors of 8, 16f or 32f bits a channel");
    app.add_option("--samples", options.layers.samples, "0, or 4 samples a pixel")
        ->check(CLI::IsMember({0, 4}))
        ->type_name("N")
        ->capture_default_str();
    add_context_option(app, options.context);
    add_size_option(app, options.layers.size);
    app.add_option("--repeat", options.repeat, "Draw this many times and print the median time")
        ->check(integer_in(1, 10'000))
        ->type_name("N");
    app.add_option("--out", options.outputs.picture, "Write the picture")->type_name("FILE.png");
    app.add_option(
           "--out-dir", options.directory,
           "Write picture.png and the color of each layer, layer-NNN.png, in the place of the "
           "layers of an earlier run")
        ->type_name("DIR");
    app.add_flag("--floats", options.floats,
                 "Write picture, layers and their depths as PFM files into DIR, too");
    add_json_option(app, options.json);
}

Status check_options(const PeelingOptions &options)
{
    const GLenum func = options.layers.func;
    if (options.all && (func == GL_LEQUAL || func == GL_GEQUAL))
        return Error{"--all needs --func less or greater: which fragments of equal depth are first "
                     "in the next pass is known from those alone"};
    if (options.floats && options.directory.empty())
        return Error{"--floats needs --out-dir"};
    return ok;
}

} // namespace kb
