// SPDX-License-Identifier: MIT
//
// Measures the hard cases on the driver that the environment chooses, and writes the rows of their
// table as JSON.

#include "tests/hard_cases/cases.hpp"
#include "tests/hard_cases/rivals.hpp"

#include "bench/gl_scene.hpp"
#include "lib/app/command_line.hpp"
#include "lib/gl/context.hpp"
#include "lib/io/output_file.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>

namespace
{

using namespace kb;
using namespace kb::hard;

int max_samples(const Gl &gl)
{
    GLint color = 0;
    GLint depth = 0;
    gl.GetIntegerv(GL_MAX_COLOR_TEXTURE_SAMPLES, &color);
    gl.GetIntegerv(GL_MAX_DEPTH_TEXTURE_SAMPLES, &depth);
    return std::min(color, depth);
}

/// Why the case cannot be drawn in this shape, or nothing.
std::string why_not(const Gl &gl, const Case &hard_case, const Method &method, const Shape &shape)
{
    if (shape.samples > max_samples(gl))
        return fmt::format("this driver has no textures of {} samples", shape.samples);
    if (method.name() == "kbuffer-program" && !hard_case.program_cannot.empty())
        return hard_case.program_cannot;
    return method.why_not(shape);
}

struct Options {
    std::string flaw = "none";
    std::optional<int> only;
    std::string out;
};

nlohmann::json measure(const Gl &gl, const Options &options)
{
    static const std::map<std::string, Flaw> flaws{{"none", Flaw::none},
                                                   {"lost-layer", Flaw::lost_layer},
                                                   {"swapped-layers", Flaw::swapped_layers}};
    const Flaw flaw = flaws.at(options.flaw);
    std::vector<std::unique_ptr<Method>> methods;
    methods.push_back(make_peeling(gl));
    methods.push_back(make_program(gl));
    std::vector<Row> rows;
    for (const Case &hard_case : all_cases()) {
        if ((flaw == Flaw::swapped_layers && !hard_case.about_order) ||
            (options.only && *options.only != hard_case.number))
            continue;
        for (const Form &form : hard_case.forms) {
            for (const auto &method : methods) {
                method->set_flaw(flaw);
                Row row{hard_case.number,
                        hard_case.name,
                        hard_case.promise,
                        form.name,
                        std::string(method->name()),
                        {},
                        why_not(gl, hard_case, *method, form.shape)};
                if (row.why_not.empty())
                    row.outcome = hard_case.measure(gl, *method, form.shape);
                rows.push_back(std::move(row));
            }
        }
    }
    nlohmann::json digests;
    for (const auto &method : methods)
        digests[std::string(method->name())] = fmt::format("{:016x}", method->digest());
    return {{"rows", to_json(rows)}, {"digests", digests}};
}

} // namespace

int main(int argc, char **argv)
{
    CLI::App app{"Measures the cases that must stay numerically stable: by both extensions on a "
                 "driver that has them, by other methods on one that has not.",
                 "hard-cases"};
    Options options;
    app.add_option("--flaw", options.flaw,
                   "none, lost-layer or swapped-layers: done to one sample of each case, so that "
                   "none must come out right")
        ->check(CLI::IsMember({"none", "lost-layer", "swapped-layers"}));
    app.add_option("--only", options.only, "the cases of this number only; 0: invariances")
        ->check(CLI::Range(0, 25));
    app.add_option("--out", options.out, "file for the rows, JSON")->required();
    if (const auto status = parse_command_line(app, argc, argv))
        return *status;
    try {
        const auto context = bench::must(make_context("osmesa"));
        const Gl &gl = context->gl();
        const bool ours = static_cast<bool>(require_depth_peeling(gl));
        nlohmann::json document =
            ours ? measure(gl, options) : nlohmann::json{{"rows", to_json(measure_rivals(gl))}};
        document["driver"] = describe_driver(gl);
        const std::string text = document.dump(1) + "\n";
        bench::must(write_file(options.out, std::as_bytes(std::span(text))));
    } catch (const std::exception &error) {
        return fail(app, {error.what()}, exit_unsupported);
    }
    return 0;
}
