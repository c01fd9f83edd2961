// SPDX-License-Identifier: MIT

#include "tests/support/fragment_reference.hpp"

#include "tests/support/process.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <fstream>

namespace kb::test
{

FragmentReference::FragmentReference(const TempDirectory &directory, const FragmentSource &source)
    : side_(source.side), samples_(static_cast<std::size_t>(std::max(source.samples, 1))),
      fragments_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) * samples_)
{
    const std::string file = directory / "fragments";
    auto environment = mesa_environment(stock_prefix());
    environment["GALLIUM_DRIVER"] = source.driver;
    const auto result = run({KBUFFER_FRAGMENT_DUMP, source.mesh, std::to_string(source.side),
                             fmt::format("{}", source.alpha), file, source.depth_format,
                             std::to_string(source.samples)},
                            environment);
    EXPECT_EQ(result.status, 0) << result.err;
    std::ifstream stream(file, std::ios::binary);
    const std::size_t row_size = static_cast<std::size_t>(side_) * samples_;
    std::array<std::uint32_t, 6> words{};
    while (stream.read(reinterpret_cast<char *>(words.data()), sizeof(words))) {
        const std::size_t row = static_cast<std::size_t>(side_) - 1 - words[0] / row_size;
        Fragment fragment{std::bit_cast<float>(words[1]), {}};
        for (int c = 0; c < 4; ++c)
            fragment.color[c] = std::bit_cast<float>(words[std::size_t(2 + c)]);
        fragments_.at(row * row_size + words[0] % row_size).push_back(fragment);
    }
}

void FragmentReference::sort(const std::string &func)
{
    const bool greater = func == "greater" || func == "gequal";
    for (auto &fragments : fragments_) {
        if (func == "lequal" || func == "gequal") // Equal depths: the last one drawn comes first.
            std::reverse(fragments.begin(), fragments.end());
        std::stable_sort(fragments.begin(), fragments.end(),
                         [greater](const Fragment &a, const Fragment &b) {
                             return greater ? a.depth > b.depth : a.depth < b.depth;
                         });
    }
}

std::size_t FragmentReference::deepest() const
{
    std::size_t deepest = 0;
    for (const auto &fragments : fragments_)
        deepest = std::max(deepest, fragments.size());
    return deepest;
}

std::size_t FragmentReference::fragment_count() const
{
    std::size_t count = 0;
    for (const auto &fragments : fragments_)
        count += fragments.size();
    return count;
}

ImageRgbaF FragmentReference::compose(std::size_t k, bool farthest_first) const
{
    ImageRgbaF image(side_, side_);
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
        double color[3] = {};
        for (std::size_t s = 0; s < samples_; ++s) {
            const auto &fragments = fragments_[p * samples_ + s];
            const std::size_t count = std::min(k, fragments.size());
            double transmittance = 1.0;
            for (std::size_t i = 0; i < count; ++i) {
                const glm::vec4 &next = fragments[farthest_first ? count - 1 - i : i].color;
                for (int c = 0; c < 3; ++c)
                    color[c] += transmittance * double(next.a) * double(next[c]);
                transmittance *= 1.0 - double(next.a);
            }
            for (double &channel : color)
                channel += transmittance;
        }
        for (int c = 0; c < 3; ++c)
            image.pixels[p][c] = static_cast<float>(color[c] / static_cast<double>(samples_));
        image.pixels[p].a = 1.0F;
    }
    return image;
}

} // namespace kb::test
