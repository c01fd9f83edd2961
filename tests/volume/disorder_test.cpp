// SPDX-License-Identifier: MIT

#include "volume/disorder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace
{

using Sequence = std::vector<std::uint32_t>;

/// The ranks in the order in which a k-buffer lets them go: the nearest of those that wait and the
/// one that arrives.
Sequence leave_kbuffer(const Sequence &arrivals, std::size_t k)
{
    Sequence by_arrival(arrivals.size()); // Ranks.
    std::iota(by_arrival.begin(), by_arrival.end(), 0U);
    std::ranges::sort(by_arrival, {}, [&](std::uint32_t rank) { return arrivals[rank]; });

    Sequence waiting;
    Sequence left;
    const auto let_go = [&] {
        const auto nearest = std::ranges::min_element(waiting);
        left.push_back(*nearest);
        waiting.erase(nearest);
    };
    for (const std::uint32_t rank : by_arrival) {
        waiting.push_back(rank);
        if (waiting.size() > k)
            let_go();
    }
    while (!waiting.empty())
        let_go();
    return left;
}

int displacement(const Sequence &arrivals)
{
    return kb::SequenceMeter().displacement(arrivals);
}

TEST(Disorder, IsHowManyPlacesLateTheLatestFragmentIs)
{
    EXPECT_EQ(displacement({}), 0);
    EXPECT_EQ(displacement({7}), 0);
    EXPECT_EQ(displacement({0, 1, 2, 3}), 0);
    EXPECT_EQ(displacement({5, 100, 3'000'000'000U}), 0) << "numbers need not be consecutive";
    EXPECT_EQ(displacement({1, 0, 2, 3}), 1);
    EXPECT_EQ(displacement({3, 0, 1, 2}), 3) << "the nearest comes last";
    EXPECT_EQ(displacement({1, 2, 3, 0}), 1) << "the farthest comes first, and waits";
    EXPECT_EQ(displacement({3, 2, 1, 0}), 3) << "back to front";
}

TEST(Disorder, IsTheLeastKThatPutsASequenceInOrder)
{
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
        Sequence arrivals(1 + random() % 24);
        std::iota(arrivals.begin(), arrivals.end(), 0U);
        // Shuffled in blocks, so that all displacements occur.
        const auto block = static_cast<std::ptrdiff_t>(1 + random() % arrivals.size());
        for (auto first = arrivals.begin(); first != arrivals.end();) {
            const auto last = first + std::min(block, arrivals.end() - first);
            std::shuffle(first, last, random);
            first = last;
        }
        const auto k = static_cast<std::size_t>(displacement(arrivals));
        EXPECT_TRUE(std::ranges::is_sorted(leave_kbuffer(arrivals, k)));
        if (k > 0) {
            EXPECT_FALSE(std::ranges::is_sorted(leave_kbuffer(arrivals, k - 1)));
        }
    }
}

TEST(Disorder, OfAPictureIsThatOfItsWorstPixel)
{
    kb::Disorder disorder;
    EXPECT_EQ(disorder.displacement(), 0);
    EXPECT_EQ(disorder.share_wrong(0), 0.0);

    disorder.add_pixel(Sequence{});
    disorder.add_pixel(Sequence{4, 5});
    disorder.add_pixel(Sequence{3, 0, 1, 2});
    disorder.add_pixel(Sequence{1, 0});
    disorder.add_pixel(Sequence{1, 2, 0});
    EXPECT_EQ(disorder.pixels(), 4U) << "one has no fragment";
    EXPECT_EQ(disorder.fragments(), 11U);
    EXPECT_EQ(disorder.deepest(), 4);
    EXPECT_EQ(disorder.displacement(), 3);
    EXPECT_EQ(disorder.share_wrong(0), 0.75);
    EXPECT_EQ(disorder.share_wrong(1), 0.25);
    EXPECT_EQ(disorder.share_wrong(2), 0.25);
    EXPECT_EQ(disorder.share_wrong(3), 0.0);
    EXPECT_EQ(disorder.share_wrong(100), 0.0);
}

} // namespace
