// SPDX-License-Identifier: MIT

#include "lib/app/long_work.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace kb
{

/// What a signal handler may write to.
static volatile std::sig_atomic_t interrupt = 0;

LongWork::LongWork(std::string program, std::string what, std::string how_to_avoid,
                   std::function<std::string()> stopped)
    : program_(std::move(program)), what_(std::move(what)), how_to_avoid_(std::move(how_to_avoid)),
      stopped_(std::move(stopped)), terminal_(isatty(STDERR_FILENO) != 0)
{
    interrupt = 0;
    struct sigaction action = {};
    action.sa_handler = [](int) { interrupt = 1; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, nullptr, &before_);
    if (before_.sa_handler != SIG_IGN) // Of a job in the background.
        sigaction(SIGINT, &action, nullptr);
}

LongWork::~LongWork()
{
    sigaction(SIGINT, &before_, nullptr);
    if (line_is_open_)
        std::fputs("\n", stderr);
}

bool LongWork::interrupted()
{
    return interrupt != 0;
}

bool LongWork::go_on()
{
    ++steps_;
    show(Clock::now());
    if (reason_.empty() && interrupted())
        reason_ = "interrupted";
    if (reason_.empty() && stopped_)
        reason_ = stopped_();
    return reason_.empty();
}

/// Nothing of what is short; then one line that changes, or, in a file, one every ten seconds.
void LongWork::show(Clock::time_point now)
{
    using namespace std::chrono_literals;
    if (now - start_ < 2s || now - shown_ < (terminal_ ? 500ms : 10'000ms))
        return;
    shown_ = now;
    const std::string line = fmt::format(
        "{}: {}, {} passes, {} s so far ({})", program_, what_, steps_,
        std::chrono::duration_cast<std::chrono::seconds>(now - start_).count(), how_to_avoid_);
    std::fputs((terminal_ ? "\r" + line : line + "\n").c_str(), stderr);
    std::fflush(stderr);
    line_is_open_ = terminal_;
}

} // namespace kb
