// SPDX-License-Identifier: MIT

#include "bench/machine.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace kb::bench
{

static std::string processor_name()
{
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name"))
            return line.substr(std::min(line.find(": ") + 2, line.size()));
    return "unknown";
}

/// Of this process: a container may have fewer than the machine.
static int processor_count()
{
    cpu_set_t set;
    CPU_ZERO(&set);
    return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

nlohmann::json describe_machine()
{
    utsname system{};
    uname(&system);
    std::array<double, 1> load{};
    const bool loaded = getloadavg(load.data(), 1) == 1;
    const char *threads = std::getenv("LP_NUM_THREADS");
    return {{"processor", processor_name()},
            {"processors", processor_count()},
            {"memory_mib", sysconf(_SC_PHYS_PAGES) / 1024 * sysconf(_SC_PAGESIZE) / 1024},
            {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)},
            {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
            {"load_at_start", loaded ? nlohmann::json(load[0]) : nlohmann::json()},
            {"lp_num_threads", threads ? nlohmann::json(threads) : nlohmann::json()}};
}

} // namespace kb::bench
