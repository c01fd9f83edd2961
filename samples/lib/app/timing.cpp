// SPDX-License-Identifier: MIT

#include "lib/app/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace kb
{

Spread spread_of(std::span<const double> values)
{
    if (values.empty())
        return {};
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const auto percentile = [&sorted](double share) {
        const double rank = share * static_cast<double>(sorted.size() - 1);
        const auto below = static_cast<std::size_t>(rank);
        const std::size_t above = std::min(below + 1, sorted.size() - 1);
        const double part = rank - static_cast<double>(below);
        return sorted[below] + part * (sorted[above] - sorted[below]);
    };
    return {percentile(0.5), percentile(0.05), percentile(0.95), values.size()};
}

std::string describe(const Spread &milliseconds, std::string_view also)
{
    std::string more;
    if (milliseconds.count > 1)
        more = fmt::format("5 % {:.2f}, 95 % {:.2f}, {} times", milliseconds.p5, milliseconds.p95,
                           milliseconds.count);
    if (!also.empty())
        more += fmt::format("{}{}", more.empty() ? "" : "; ", also);
    return fmt::format("{:.2f} ms{}", milliseconds.median,
                       more.empty() ? "" : fmt::format(" ({})", more));
}

double milliseconds(const Gl &gl, const std::function<void()> &work)
{
    gl.Finish();
    const auto start = std::chrono::steady_clock::now();
    work();
    gl.Finish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

} // namespace kb
