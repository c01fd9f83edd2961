// SPDX-License-Identifier: MIT

#include "volume/disorder.hpp"

#include <algorithm>
#include <numeric>

namespace kb
{

int SequenceMeter::displacement(std::span<const std::uint32_t> arrivals)
{
    fragments_.clear();
    for (const std::uint32_t arrival : arrivals)
        fragments_.push_back({arrival, static_cast<int>(fragments_.size())});
    std::ranges::sort(fragments_, {}, &Fragment::arrival);

    int latest = 0;
    int place = 0;
    for (const Fragment &fragment : fragments_)
        latest = std::max(latest, place++ - fragment.rank);
    return latest;
}

void Disorder::add_pixel(std::span<const std::uint32_t> arrivals)
{
    if (arrivals.empty())
        return;
    ++pixels_;
    fragments_ += arrivals.size();
    deepest_ = std::max(deepest_, static_cast<int>(arrivals.size()));
    const auto displacement = static_cast<std::size_t>(meter_.displacement(arrivals));
    if (pixels_by_displacement_.size() <= displacement)
        pixels_by_displacement_.resize(displacement + 1);
    ++pixels_by_displacement_[displacement];
}

int Disorder::displacement() const
{
    return pixels_ == 0 ? 0 : static_cast<int>(pixels_by_displacement_.size()) - 1;
}

double Disorder::share_wrong(int k) const
{
    const std::span counts(pixels_by_displacement_);
    const auto right = std::min(static_cast<std::size_t>(k) + 1, counts.size());
    const auto wrong = counts.subspan(right);
    return pixels_ == 0 ? 0.0
                        : static_cast<double>(
                              std::accumulate(wrong.begin(), wrong.end(), std::uint64_t{0})) /
                              static_cast<double>(pixels_);
}

} // namespace kb
