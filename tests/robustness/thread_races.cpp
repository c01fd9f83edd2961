// SPDX-License-Identifier: MIT
//
// Draws k-buffers and layers in two contexts of two threads at a time, in whole frames and in many
// short scenes, so that llvmpipe's threads rasterize one scene while the next is being binned, and
// scenes of both contexts in turn. ThreadSanitizer, which this and Mesa are compiled with, reports
// races of memory; that none shows in the pictures is checked here: same input, same bits.
//
// The number of rasterizer threads is LP_NUM_THREADS.

#include "lib/app/command_line.hpp"
#include "lib/gl/context.hpp"
#include "tests/robustness/frame.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <barrier>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

namespace kb::test
{

namespace
{

constexpr int num_contexts = 2;

struct Counts {
    int passed = 0;
    int failed = 0;
    std::string message;
};

/// In a thread of its own: frames in a context of its own
void draw_frames(int frames, std::barrier<> &start, Counts &counts)
{
    auto context = make_context("osmesa");
    start.arrive_and_wait();
    if (!context) {
        ++counts.failed;
        counts.message = context.error().message;
        return;
    }
    std::vector<float> expected;
    for (int i = 0; i < frames; ++i) {
        auto frame = draw_frame((*context)->gl(), {.split = i % 2 == 1});
        if (frame && i == 0)
            expected = *frame;
        if (frame && frame->size() == expected.size() &&
            std::memcmp(frame->data(), expected.data(), expected.size() * sizeof(float)) == 0) {
            ++counts.passed;
        } else {
            ++counts.failed;
            counts.message = frame ? "a frame differs from the first" : frame.error().message;
        }
    }
}

} // namespace

} // namespace kb::test

int main(int argc, char **argv)
{
    using namespace kb::test;

    CLI::App app("Draws in two contexts of two threads at a time", "thread-races");
    int frames = 6;
    app.add_option("--frames", frames, "how many each context draws")->check(CLI::Range(1, 10000));
    if (const auto status = kb::parse_command_line(app, argc, argv))
        return *status;

    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    std::array<Counts, num_contexts> counts;
    std::barrier start(num_contexts);
    {
        std::vector<std::jthread> threads;
        for (Counts &own : counts)
            threads.emplace_back([frames, &start, &own] { draw_frames(frames, start, own); });
    }
    Counts all;
    for (const Counts &own : counts) {
        all.passed += own.passed;
        all.failed += own.failed;
        if (!own.message.empty())
            fmt::print("{}\n", own.message);
    }
    fmt::print("{} passed, {} failed, 0 skipped\n", all.passed, all.failed);
    return all.failed == 0 ? 0 : 1;
}
