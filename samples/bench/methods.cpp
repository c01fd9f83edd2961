// SPDX-License-Identifier: MIT

#include "bench/methods.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kb::bench
{

std::string label(const Run &run)
{
    std::string text = run.method;
    if (!run.variant.empty())
        text += "-" + run.variant;
    return run.k == 0 ? text : fmt::format("{}-{}", text, run.k);
}

std::vector<Run> plan_runs(std::span<const std::string> names, std::span<const int> ks)
{
    constexpr std::array no_k{0};
    std::vector<Run> runs;
    for (const Method &method : methods) {
        if (method.max_k != 0 && std::ranges::find(names, method.name) == names.end())
            continue;
        for (const Variant &variant : method.variants) {
            for (const int k : method.max_k == 0 ? std::span<const int>(no_k) : ks) {
                if (k <= method.max_k)
                    runs.push_back({std::string(method.name), std::string(variant.name),
                                    std::string(method.driver), std::string(variant.environment),
                                    k});
            }
        }
    }
    return runs;
}

} // namespace kb::bench
