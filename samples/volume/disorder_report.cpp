// SPDX-License-Identifier: MIT

#include "volume/disorder_report.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kb
{

Result<Difference> color_error(const ImageRgbaF &picture, const ImageRgbaF &exact,
                               std::uint64_t pixels)
{
    auto difference = compare(picture, exact, 1.0 / 255.0);
    if (!difference || pixels == 0)
        return difference;
    // The others are background in both.
    const double all = static_cast<double>(picture.pixels.size()) / static_cast<double>(pixels);
    difference->rmse *= std::sqrt(all);
    difference->share *= all;
    return difference;
}

std::string describe(const DisorderReport &report, int k)
{
    const Disorder &fragments = report.fragments;
    std::string text = fmt::format(
        "disorder: up to {} place{} late of {} fragments, {} pixels", fragments.displacement(),
        fragments.displacement() == 1 ? "" : "s", fragments.deepest(), fragments.pixels());
    if (report.colors)
        text += fmt::format("; {:.4g} % of them out of order with k = {}, colors off by {:.2g} at "
                            "most (RMS {:.2g}), by more than 1/255 in {:.4g} %",
                            100.0 * fragments.share_wrong(k), k, report.colors->max,
                            report.colors->rmse, 100.0 * report.colors->share);
    return text;
}

} // namespace kb
