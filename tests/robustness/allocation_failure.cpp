// SPDX-License-Identifier: MIT
//
// Each allocation that the project's files in Mesa make fails once. Nothing crashes, and nothing is
// lost without a word: what was drawn is whole, or there is GL_OUT_OF_MEMORY (or no context, while
// one is being made). The next frame is whole again, in the same context.
//
// Each failure has a process of its own, made by fork(), since much is allocated once in a process.

#include "lib/app/command_line.hpp"
#include "lib/gl/context.hpp"
#include "lib/gl/shared_library.hpp"
#include "tests/robustness/failing_allocations.hpp"
#include "tests/robustness/frame.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kb::test
{

namespace
{

/// Mesa's functions that allocate for their caller. What NIR and LLVM allocate is left out, since
/// all of Mesa takes it for granted that they get it; softpipe_create_sampler_state(), too.
const std::array<std::string, 12> helpers = {
    "os_malloc_aligned",
    "mem_dup",
    "lp_scene_new_data_block",
    "lp_scene_add_resource_reference",
    "blob_reserve_bytes",
    "blob_write_bytes",
    "grow_to_fit",
    "sp_create_tgsi_sampler",
    "sp_create_tex_tile_cache",
    "tgsi_exec_machine_create",
    "align_malloc",
    "lp_scene_alloc_aligned",
};

struct Configuration {
    const char *driver;
    const char *threads; ///< Of llvmpipe's rasterizer.
};

/// What a process reports of its failure.
struct Report {
    bool failed;  ///< The n-th allocation was reached.
    bool sound;   ///< Everything was as it has to be.
    bool created; ///< There was a context in the end.
    std::uintptr_t site;
    std::array<std::uintptr_t, 512> places;
    std::array<char, 200> message;
};

void say(Report &report, const std::string &message)
{
    report.message[message.copy(report.message.data(), report.message.size() - 1)] = '\0';
}

/// The GL errors of this process, which the frame asks for here and there.
std::vector<GLenum> gl_errors;
GLenum (*real_get_error)() = nullptr;

GLenum get_error()
{
    const GLenum error = real_get_error();
    if (error != GL_NO_ERROR)
        gl_errors.push_back(error);
    return error;
}

struct Attempt {
    std::vector<float> picture; ///< Empty if the frame was given up.
    std::optional<std::string> told;
    bool wrong_error = false; ///< There were errors, and the first was not for lack of memory.
};

Attempt attempt_frame(const Context &context)
{
    Gl gl = context.gl();
    real_get_error = gl.GetError;
    gl.GetError = get_error;
    gl_errors.clear();
    Attempt attempt;
    if (auto frame = draw_frame(gl, {}))
        attempt.picture = *std::move(frame);
    else
        attempt.told = frame.error().message;
    while (gl.GetError() != GL_NO_ERROR) {
    }
    if (!gl_errors.empty()) {
        attempt.told = attempt.told.value_or("a GL error");
        attempt.wrong_error = gl_errors.front() != GL_OUT_OF_MEMORY;
    } else if (attempt.told) {
        attempt.wrong_error = true;
    }
    return attempt;
}

bool same(const std::vector<float> &a, const std::vector<float> &b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

/// In a process of its own: a context and two frames, while the n-th allocation of the first fails.
void run(int n, std::span<float> reference, Report &report)
{
    fail_allocation(n);
    auto context = make_context("osmesa");
    Attempt first;
    if (context)
        first = attempt_frame(**context);
    else
        first.told = context.error().message;
    const Allocations allocations = stop_failing();
    report.failed = allocations.failed;
    report.site = allocations.site;
    std::copy(allocations.places.begin(), allocations.places.end(), report.places.begin());

    if (!context)
        context = make_context("osmesa");
    if (!context)
        return say(report, "there is no context any more");
    report.created = true;
    if (reference[0] == 0.0F) {
        reference[0] = static_cast<float>(first.picture.size());
        std::copy(first.picture.begin(), first.picture.end(), reference.begin() + 1);
    }
    const auto size = static_cast<std::size_t>(reference[0]);
    const std::vector<float> expected(reference.begin() + 1, reference.begin() + 1 + size);

    if (first.wrong_error)
        return say(report, fmt::format("{} (first GL error {:#x})", *first.told,
                                       gl_errors.empty() ? 0 : gl_errors.front()));
    if (!first.told && !same(first.picture, expected))
        return say(report, "something is lost, without an error");
    if (first.told && !report.failed)
        return say(report, *first.told);
    const Attempt second = attempt_frame(**context);
    if (second.told)
        return say(report, fmt::format("the next frame: {}", *second.told));
    if (!same(second.picture, expected))
        return say(report, "something is lost in the next frame");
    report.sound = true;
}

template <class T>
std::span<T> share(std::size_t count)
{
    void *memory =
        mmap(nullptr, count * sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
        return {};
    return {static_cast<T *>(memory), count};
}

class Runner
{
public:
    Runner() : reports_(share<Report>(1)), reference_(share<float>(1 << 20)) {}

    bool ready() const { return !reports_.empty() && !reference_.empty(); }

    void run_all(const Configuration &configuration)
    {
        setenv("GALLIUM_DRIVER", configuration.driver, 1);
        setenv("LP_NUM_THREADS", configuration.threads, 1);
        const std::string name =
            fmt::format("{}, {} threads", configuration.driver, configuration.threads);
        std::fill(reference_.begin(), reference_.end(), 0.0F);

        const int before = passed_ + failed_;
        if (!run_one(-1) || !reports_[0].sound) {
            fmt::print("{}: without any failure: {}\n", name, reports_[0].message.data());
            ++failed_;
            return;
        }
        for (int n = 0; n < max_allocations; ++n) {
            const bool ended = run_one(n);
            if (ended && !reports_[0].failed)
                break;
            if (ended && reports_[0].sound) {
                ++passed_;
                continue;
            }
            ++failed_;
            fmt::print("{}: allocation {}, {}: {}\n", name, n,
                       reports_[0].site ? describe_site(reports_[0].site) : "?",
                       reports_[0].message.data());
            std::fflush(stdout);
        }
        fmt::print("{}: {} allocations failed in turn\n", name, passed_ + failed_ - before);
        std::fflush(stdout);
    }

    /// Prints the call sites that were reached.
    void list_places() const
    {
        for (const auto &place : places_)
            fmt::print("    {}\n", place);
    }

    int passed() const { return passed_; }
    int failed() const { return failed_; }

private:
    static constexpr int max_allocations = 2000;

    /// Returns whether the process came to its end.
    bool run_one(int n)
    {
        Report &report = reports_[0];
        report = {};
        std::fflush(nullptr);
        const pid_t child = fork();
        if (child < 0) {
            say(report, "no process can be made");
            return false;
        }
        if (child == 0) {
            alarm(120);
            run(n, reference_, report);
            std::exit(0); // Here AddressSanitizer looks for leaks.
        }
        int status = 0;
        waitpid(child, &status, 0);
        for (const auto place : report.places)
            if (place && known_.insert(place).second)
                places_.insert(describe_site(place));
        if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
            return true;
        if (report.message[0] == '\0')
            say(report, WIFSIGNALED(status) ? fmt::format("killed by signal {}", WTERMSIG(status))
                                            : fmt::format("exit status {}", WEXITSTATUS(status)));
        report.sound = false;
        return false;
    }

    std::span<Report> reports_;
    std::span<float> reference_;
    std::set<std::uintptr_t> known_;
    std::set<std::string> places_;
    int passed_ = 0;
    int failed_ = 0;
};

/// The sources below a folder, by their paths in it
std::vector<std::string> find_sources(const std::filesystem::path &folder)
{
    std::vector<std::string> files;
    for (const auto &entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".c")
            files.push_back(std::filesystem::relative(entry.path(), folder).string());
    return files;
}

} // namespace

} // namespace kb::test

int main(int argc, char **argv)
{
    using namespace kb::test;

    CLI::App app("Lets each allocation of the project's files in Mesa fail once",
                 "allocation-failure");
    std::filesystem::path sources;
    bool list = false;
    app.add_option("sources", sources, "mesa-patches/overlay: the files whose allocations fail")
        ->required()
        ->check(CLI::ExistingDirectory);
    app.add_flag("--list", list, "print the call sites that were reached");
    if (const auto status = kb::parse_command_line(app, argc, argv))
        return *status;

    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    const auto library = kb::SharedLibrary::open("libOSMesa.so.8");
    if (!library)
        return kb::fail(app, library.error(), kb::exit_unsupported);
    const std::vector<std::string> files = find_sources(sources);
    if (auto watched = watch_allocations("libOSMesa.so", files, helpers); !watched)
        return kb::fail(app, watched.error(), kb::exit_unsupported);
    Runner runner;
    if (!runner.ready())
        return kb::fail(app, {"no memory is left"}, kb::exit_unsupported);

    for (const Configuration &configuration :
         {Configuration{"llvmpipe", "0"}, {"llvmpipe", "2"}, {"softpipe", "0"}})
        runner.run_all(configuration);
    if (list)
        runner.list_places();
    fmt::print("{} passed, {} failed, 0 skipped\n", runner.passed(), runner.failed());
    return runner.failed() == 0 ? 0 : 1;
}
