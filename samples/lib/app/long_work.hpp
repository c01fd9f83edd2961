// SPDX-License-Identifier: MIT

#pragma once

#include <chrono>
#include <csignal>
#include <functional>
#include <string>

namespace kb
{

/// Asked between the steps of long work: whether to go on with it. Empty: yes.
using GoOn = std::function<bool()>;

/// Work that may take long: says on the standard error how it gets on, and ends between two steps
/// on Ctrl-C (a second one ends the program) or when something else says so. One at a time.
class LongWork
{
public:
    /// Lines are "program: what, ..., how it can be left out". `stopped` says why the work is to
    /// end; empty as long as it is not.
    LongWork(std::string program, std::string what, std::string how_to_avoid,
             std::function<std::string()> stopped = {});
    ~LongWork();
    LongWork(const LongWork &) = delete;
    LongWork &operator=(const LongWork &) = delete;

    /// After a step: whether there is to be another.
    bool go_on();

    /// Why the work was to end; empty if it was not.
    const std::string &reason() const { return reason_; }

    /// Whether Ctrl-C was that.
    static bool interrupted();

private:
    using Clock = std::chrono::steady_clock;

    void show(Clock::time_point now);

    std::string program_;
    std::string what_;
    std::string how_to_avoid_;
    std::function<std::string()> stopped_;
    std::string reason_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point shown_ = start_;
    int steps_ = 0;
    bool terminal_;
    bool line_is_open_ = false;
    struct sigaction before_ = {};
};

} // namespace kb
