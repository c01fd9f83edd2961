// SPDX-License-Identifier: MIT
//
// Measures transparency methods side by side: the methods of stock Mesa and those of the patched
// one, each driver in a process of its own, taking turns frame by frame.

#include "bench/options.hpp"
#include "bench/report.hpp"
#include "bench/study.hpp"
#include "bench/worker.hpp"
#include "bench/worker_process.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

int main(int argc, char **argv)
{
    CLI::App app{"Milliseconds, memory and error of transparency methods, measured side by side on "
                 "stock Mesa and on Mesa with the k-buffer extensions.",
                 "kbuffer-bench"};
    kb::bench::Options options;
    if (const auto status = kb::bench::parse_options(app, options, argc, argv))
        return *status;
    if (options.worker)
        return kb::bench::work();

    if (const auto writable = kb::bench::prepare_outputs(options.out, options.pictures); !writable)
        return kb::fail(app, writable.error(), kb::exit_bad_input);
    try {
        const kb::bench::Study study = kb::bench::run_study(options);
        fmt::print("{}", kb::bench::to_table(study.rows));
        const auto document = kb::bench::to_json(study.machine, study.rows);
        if (const auto written = kb::bench::write_json(options.out, document); !written)
            return kb::fail(app, written.error(), kb::exit_bad_input);
        fmt::print("Results: {}\n", options.out.string());
    } catch (const kb::bench::BadInput &error) {
        return kb::fail(app, {error.what()}, kb::exit_bad_input);
    } catch (const std::exception &error) {
        return kb::fail(app, {error.what()}, kb::exit_unsupported);
    }
    return kb::finish(app);
}
