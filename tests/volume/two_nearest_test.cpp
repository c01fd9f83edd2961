// SPDX-License-Identifier: MIT
//
// What leaves those that wait in the k-buffer, with the program interpreted on the CPU.

#include "volume/two_nearest.hpp"

#include "tests/programs/arb_interpreter.hpp"

#include <fmt/format.h>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>

namespace
{

using kb::test::ArbInterpreter;

constexpr int first_entry = 3;

/// Fragments (depth, value) in the order in which they leave, k at the end of which by a flush with
/// as many fragments behind everything.
std::vector<glm::vec2> stream(int k, std::span<const glm::vec2> fragments)
{
    const int result = first_entry + kb::waiting_entries(k);
    const ArbInterpreter program("!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n" +
                                 kb::make_take_nearest(k, first_entry) +
                                 fmt::format("MOV result.kbuffer[{}].xy, nearest;\nEND\n", result));
    std::vector<glm::vec4> kbuffer(static_cast<std::size_t>(result) + 1, glm::vec4(0.0F));
    std::vector<glm::vec2> left;
    const auto insert = [&](glm::vec2 fragment) {
        EXPECT_TRUE(program.run({glm::vec4(fragment, 0.0F, 0.0F), 0.0F}, kbuffer));
        left.emplace_back(kbuffer.back());
    };
    for (const glm::vec2 &fragment : fragments)
        insert(fragment);
    for (int i = 0; i < k; ++i)
        insert({1e9F, 0.0F});
    for (int i = 0; i < first_entry; ++i)
        EXPECT_EQ(kbuffer[static_cast<std::size_t>(i)], glm::vec4(0.0F)) << "entries of others";
    return left;
}

std::vector<glm::vec2> stably_sorted(std::vector<glm::vec2> fragments)
{
    std::stable_sort(fragments.begin(), fragments.end(),
                     [](glm::vec2 a, glm::vec2 b) { return a.x < b.x; });
    return fragments;
}

/// Fragments of whole depths from 1, with ties and values of their own, each put forward by at most
/// `early` places: so that no more than that many others come late before it.
std::vector<glm::vec2> nearly_sorted(int count, int early, std::mt19937 &random)
{
    std::vector<glm::vec2> fragments;
    std::uniform_int_distribution<int> depth(1, count / 2);
    for (int i = 0; i < count; ++i)
        fragments.emplace_back(depth(random), 0.0F);
    fragments = stably_sorted(fragments);
    // Sorting by place + [0, early] moves nothing more than that.
    std::uniform_real_distribution<float> move(0.0F, static_cast<float>(early));
    std::vector<std::pair<float, glm::vec2>> keyed;
    for (int i = 0; i < count; ++i)
        keyed.emplace_back(static_cast<float>(i) + move(random), fragments[std::size_t(i)]);
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const auto &a, const auto &b) { return a.first < b.first; });
    for (int i = 0; i < count; ++i)
        fragments[std::size_t(i)] = {keyed[std::size_t(i)].second.x, static_cast<float>(i)};
    return fragments;
}

class TakeNearest : public testing::TestWithParam<int>
{
};

TEST_P(TakeNearest, SortsWhatIsNoMoreThanKPlacesOut)
{
    const int k = GetParam();
    std::mt19937 random(static_cast<unsigned>(k));
    for (int round = 0; round < 50; ++round) {
        const auto fragments = nearly_sorted(100, k, random);
        const auto left = stream(k, fragments);
        ASSERT_EQ(left.size(), fragments.size() + static_cast<std::size_t>(k));
        // First the k empty places, which are in front of everything.
        for (int i = 0; i < k; ++i)
            ASSERT_EQ(left[static_cast<std::size_t>(i)], glm::vec2(0.0F));
        // Values are in the order of arrival: equal depths leave in it.
        const std::vector<glm::vec2> sorted(left.begin() + k, left.end());
        ASSERT_EQ(sorted, stably_sorted(fragments));
    }
}

TEST_P(TakeNearest, GivesTheNearestOfThoseThatWaitWhateverComes)
{
    const int k = GetParam();
    std::mt19937 random(99);
    std::uniform_int_distribution<int> depth(1, 20);
    std::vector<glm::vec2> fragments;
    for (int i = 0; i < 300; ++i)
        fragments.emplace_back(depth(random), static_cast<float>(i));
    std::vector<glm::vec2> waiting(static_cast<std::size_t>(k), glm::vec2(0.0F));
    const auto left = stream(k, fragments);
    for (std::size_t i = 0; i < fragments.size(); ++i) {
        waiting.push_back(fragments[i]);
        const auto nearest = std::min_element(waiting.begin(), waiting.end(),
                                              [](glm::vec2 a, glm::vec2 b) { return a.x < b.x; });
        ASSERT_EQ(left[i], *nearest) << i;
        waiting.erase(nearest);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, TakeNearest, testing::Values(1, 2, 3, 6, 12, 31));

} // namespace
