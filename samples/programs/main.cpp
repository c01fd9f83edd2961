// SPDX-License-Identifier: MIT
//
// Prints a k-buffer program for ProgramStringARB(GL_KBUFFER_PROGRAM_MESA, ...).

#include "lib/app/command_line.hpp"
#include "lib/io/output_file.hpp"
#include "programs/kbuffer_program.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <cstdio>

int main(int argc, char **argv)
{
    std::string layout_name = "packed";
    int k = 8;
    std::filesystem::path out = "-";

    CLI::App app("Prints the program that keeps the k nearest fragments of each pixel, nearest "
                 "first.\nLayouts of an entry: rgbz (red, green, blue, depth), packed (two "
                 "fragments of RGBA8 and\ndepth), depth (one), depth4 (four). Clear all depths to "
                 "1 before drawing.",
                 "kbuffer-program");
    app.add_option("--layout", layout_name, "What an entry holds")
        ->check(CLI::IsMember({"rgbz", "packed", "depth", "depth4"}))
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--k", k,
                   "Fragments to keep: 1 to 64 with rgbz and depth, 128 with packed, 256 with "
                   "depth4")
        ->check(kb::integer_in(1, 256))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--out", out, "Write to this file; -: to the standard output")
        ->type_name("FILE")
        ->capture_default_str();
    if (const auto status = kb::parse_command_line(app, argc, argv))
        return *status;

    const auto layout = kb::parse_entry_layout(layout_name);
    if (!layout)
        return kb::fail(app, layout.error(), kb::exit_bad_input);
    const auto program = kb::make_insertion_program(*layout, k);
    if (!program)
        return kb::fail(app, program.error(), kb::exit_bad_input);
    if (auto writable = kb::prepare_outputs(std::array{kb::OutputFile{out, ""}}); !writable)
        return kb::fail(app, writable.error(), kb::exit_bad_input);
    if (auto written = kb::write_file(out, std::as_bytes(std::span(*program))); !written)
        return kb::fail(app, written.error(), kb::exit_bad_input);
    return kb::finish(app);
}
