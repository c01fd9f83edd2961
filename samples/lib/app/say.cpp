// SPDX-License-Identifier: MIT

#include "lib/app/say.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>

namespace kb
{

void say(std::string_view line)
{
    const std::string text = std::string(line) + '\n';
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
        return;
    // Nobody reads it any more, so it goes nowhere; a full disk stays an error of the stream.
    if (errno == EPIPE && !std::freopen("/dev/null", "w", stdout))
        std::clearerr(stdout);
}

void outlive_readers()
{
    std::signal(SIGPIPE, SIG_IGN);
}

} // namespace kb
