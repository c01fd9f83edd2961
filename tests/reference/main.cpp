// SPDX-License-Identifier: MIT
//
// Random scenes on a driver against a CPU A-buffer in double precision. check.hpp says what is
// compared, rasterizer.hpp how exactly, invariances.hpp what else has to hold.

#include "lib/app/command_line.hpp"
#include "lib/gl/context.hpp"
#include "lib/io/output_file.hpp"
#include "tests/reference/check.hpp"
#include "tests/reference/invariances.hpp"
#include "tests/reference/random_scene.hpp"
#include "tests/reference/shrink.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>

namespace
{

using namespace kb::reference;

struct Options {
    std::string driver = "llvmpipe";
    std::uint64_t seed = 1;
    std::uint64_t scenes = 500;
    double seconds = 0.0;
    std::string replay;
    std::string failures = ".";
    std::string inject = "none";
    bool invariances = false;
    bool digest = false;
    bool print = false;
};

constexpr int most_failures = 5; ///< Then it is more of the same.

/// What the parent process can still read when a driver has crashed.
struct Progress {
    std::atomic<std::uint64_t> seed{0};
};

SceneLimits limits_of(const Options &options)
{
    SceneLimits limits;
    limits.samples = options.driver == "llvmpipe" ? 4 : 0; // softpipe has no multisampling.
    limits.several_tiles = options.digest;                 // Threads have a tile each.
    return limits;
}

class Test
{
public:
    Test(const Options &options, Fault fault, const kb::Gl &gl, Progress &progress)
        : options_(options), fault_(fault), drawer_(gl), progress_(progress)
    {
    }

    kb::Result<int> run()
    {
        if (!options_.replay.empty()) {
            auto scene = kb::reference::load_scene(options_.replay);
            if (!scene)
                return scene.error();
            return finish(try_scene(*scene, 0));
        }
        const auto start = std::chrono::steady_clock::now();
        const auto elapsed = [&] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        };
        for (std::uint64_t i = 0;
             options_.seconds > 0.0 ? elapsed() < options_.seconds : i < options_.scenes; ++i) {
            const std::uint64_t seed = options_.seed + i;
            progress_.seed = seed;
            auto status = options_.invariances
                              ? try_invariances(seed)
                              : try_scene(random_scene(seed, limits_of(options_)), seed);
            if (!status || failed_ >= most_failures)
                return finish(status);
        }
        return finish(kb::ok);
    }

private:
    kb::Result<int> finish(kb::Status status) const
    {
        if (!status)
            return status.error();
        if (options_.digest)
            fmt::print("digest {:016x}\n", digest_);
        else if (!options_.invariances)
            fmt::print(
                "{}: {} fragments ({:.3f} % of all samples undecided, {} doubled, {} depths "
                "and {} channels without bound), {} layers in {} passes, {} composites, {} scenes "
                "with ties\n",
                options_.driver, statistics_.fragments,
                100.0 * static_cast<double>(statistics_.undecided) /
                    static_cast<double>(std::max<std::size_t>(statistics_.samples, 1)),
                statistics_.doubled, statistics_.unbounded_depths, statistics_.unbounded_colors,
                statistics_.layers, statistics_.passes, statistics_.composites, statistics_.ties);
        fmt::print("{} passed, {} failed, 0 skipped\n", passed_, failed_);
        return failed_ > 0 ? 1 : 0;
    }

    kb::Status try_scene(const Scene &scene, std::uint64_t seed)
    {
        if (options_.print) {
            fmt::print("{}\n", to_json(scene));
            return kb::ok;
        }
        if (options_.digest)
            return add_to_digest(scene);
        auto found = check(drawer_, scene, fault_, statistics_);
        if (!found)
            return found.error();
        if (!*found) {
            ++passed_;
            return kb::ok;
        }
        ++failed_;
        fmt::print("not ok: {}{}\n", options_.driver,
                   options_.replay.empty() ? fmt::format(" seed {}", seed) : "");
        fmt::print("  {}\n", **found);
        if (!options_.replay.empty())
            return kb::ok;
        return report_shrunk(scene, seed, (*found)->substr(0, (*found)->find(':')));
    }

    /// What is shrunk keeps the kind of its failure.
    kb::Status report_shrunk(const Scene &scene, std::uint64_t seed, const std::string &kind)
    {
        const auto first_failure = [this](const Scene &smaller) -> std::optional<std::string> {
            Statistics ignored;
            auto again = check(drawer_, smaller, fault_, ignored);
            return again ? *again : std::nullopt;
        };
        const Scene small = shrink(scene, [&](const Scene &smaller) {
            const auto failure = first_failure(smaller);
            return failure && failure->substr(0, failure->find(':')) == kind;
        });
        const std::string json = to_json(small) + "\n";
        const auto path = std::filesystem::path(options_.failures) /
                          fmt::format("failing-scene-{}-{}.json", options_.driver, seed);
        if (auto written = kb::write_file(path, std::as_bytes(std::span(json))); !written)
            return written;
        fmt::print("  shrunk from {} triangles to {}: {}\n", scene.triangle_count(),
                   small.triangle_count(), first_failure(small).value_or("it passes alone"));
        fmt::print("{}", json);
        fmt::print("  in {}; draw it again with: --driver {} --replay {}\n", path.string(),
                   options_.driver, path.string());
        return kb::ok;
    }

    kb::Status try_invariances(std::uint64_t seed)
    {
        for (const Invariance &invariance : invariances()) {
            auto found = invariance.broken(drawer_, seed, limits_of(options_));
            if (!found)
                return found.error();
            if (!*found) {
                ++passed_;
                continue;
            }
            ++failed_;
            fmt::print("not ok: {} seed {}: {}: {}\n", options_.driver, seed, invariance.name,
                       **found);
        }
        return kb::ok;
    }

    kb::Status add_to_digest(const Scene &scene)
    {
        auto seen = observe(drawer_, scene);
        if (!seen)
            return seen.error();
        digest_ = digest_of(*seen, digest_);
        ++passed_;
        return kb::ok;
    }

    const Options &options_;
    Fault fault_;
    SceneDrawer drawer_;
    Progress &progress_;
    Statistics statistics_;
    std::uint64_t digest_ = 0;
    int passed_ = 0;
    int failed_ = 0;
};

int run_test(const CLI::App &app, const Options &options, Fault fault, Progress &progress)
{
    setenv("GALLIUM_DRIVER", options.driver.c_str(), 1);
    auto context = kb::make_context("osmesa");
    if (!context)
        return kb::fail(app, context.error(), kb::exit_unsupported);
    auto status = Test(options, fault, (*context)->gl(), progress).run();
    std::fflush(stdout);
    return status ? *status : kb::fail(app, status.error(), kb::exit_unsupported);
}

/// The test in a process of its own, so that a crash of the driver leaves the scene's seed.
int run_guarded(const CLI::App &app, const Options &options, Fault fault)
{
    void *shared =
        mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED)
        return kb::fail(app, {"no shared memory"}, kb::exit_unsupported);
    auto &progress = *new (shared) Progress;
    std::fflush(stdout);
    const pid_t child = fork();
    if (child < 0)
        return kb::fail(app, {"no process can be started"}, kb::exit_unsupported);
    if (child == 0)
        std::exit(run_test(app, options, fault, progress));
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status))
        return WEXITSTATUS(status);
    fmt::print("not ok: {} was killed by signal {} at the scene of seed {}; the scene: --driver {} "
               "--seed {} --scenes 1 --print\n",
               options.driver, WTERMSIG(status), progress.seed.load(), options.driver,
               progress.seed.load());
    fmt::print("{} passed, 1 failed, 0 skipped\n", progress.seed.load() - options.seed);
    return 1;
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    CLI::App app("Compares random scenes, drawn with GL_MESA_depth_peeling and "
                 "GL_MESA_kbuffer_program, with an A-buffer in double precision",
                 "kbuffer-reference-test");
    app.add_option("--driver", options.driver, "llvmpipe or softpipe")
        ->check(CLI::IsMember({"llvmpipe", "softpipe"}))
        ->capture_default_str();
    app.add_option("--seed", options.seed, "Of the first scene; the next has the next seed")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--scenes", options.scenes, "How many scenes")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--seconds", options.seconds, "Scenes for so long instead")
        ->check(CLI::PositiveNumber);
    app.add_option("--replay", options.replay, "Only the scene in this file");
    app.add_option("--failures", options.failures, "Where failing scenes are written, shrunk")
        ->check(CLI::ExistingDirectory)
        ->capture_default_str();
    app.add_flag("--invariances", options.invariances,
                 "What must not change a scene, instead of the comparison");
    app.add_flag("--digest", options.digest,
                 "Compares nothing, prints one number for all that was drawn");
    app.add_flag("--print", options.print, "Draws nothing, prints the scenes");
    app.add_option("--inject", options.inject)->group(""); // For tests of this test.
    if (const auto status = kb::parse_command_line(app, argc, argv))
        return *status;
    const auto fault = parse_fault(options.inject);
    if (!fault)
        return kb::fail(app, fault.error(), kb::exit_bad_input);
    if (!options.replay.empty()) {
        if (const auto scene = kb::reference::load_scene(options.replay); !scene)
            return kb::fail(app, scene.error(), kb::exit_bad_input);
    }
    return run_guarded(app, options, *fault);
}
