// SPDX-License-Identifier: MIT

#include "methods.hpp"

#include <algorithm>

namespace kb::bench
{

std::vector<Run> plan_runs(std::span<const std::string> names, std::span<const int> ks)
{
    std::vector<Run> runs;
    for (const Method &method : methods) {
        if (!method.takes_k) {
            runs.push_back({std::string(method.name), std::string(method.driver), 0});
            continue;
        }
        if (std::ranges::find(names, method.name) == names.end())
            continue;
        for (const int k : ks) {
            if (method.name == "fbfetch" && k > max_fbfetch_k)
                continue;
            runs.push_back({std::string(method.name), std::string(method.driver), k});
        }
    }
    return runs;
}

} // namespace kb::bench
