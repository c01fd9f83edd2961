// SPDX-License-Identifier: MIT

#include "say.hpp"

#include <csignal>
#include <cstdio>
#include <string>

namespace kb
{

void say(std::string_view line)
{
    const std::string text = std::string(line) + '\n';
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
}

void outlive_readers()
{
    std::signal(SIGPIPE, SIG_IGN);
}

} // namespace kb
