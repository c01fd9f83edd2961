// SPDX-License-Identifier: MIT
//
// Insertion programs, interpreted on the CPU, against a stable sort of the same fragments.

#include "programs/kbuffer_program.hpp"
#include "tests/programs/arb_interpreter.hpp"

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

namespace
{

using kb::EntryLayout;
using kb::test::ArbInterpreter;
using kb::test::Fragment;

/// Fragments of few different depths (so that there are many ties), NaN and 1 among them, each with
/// a color of its own that survives eight bits.
std::vector<Fragment> random_fragments(std::size_t count, int depths, std::mt19937 &random)
{
    std::uniform_int_distribution<int> choose(-2, depths);
    std::vector<Fragment> fragments;
    for (std::size_t i = 0; i < count; ++i) {
        const int choice = choose(random);
        const float depth = choice == -2   ? std::nanf("")
                            : choice == -1 ? 1.0F
                                           : static_cast<float>(choice) / (float(depths) + 1.0F);
        fragments.push_back({glm::vec4(i % 256, i / 256, 77.0F, 255.0F) / 255.0F, depth});
    }
    return fragments;
}

std::vector<Fragment> nearest(std::vector<Fragment> fragments, std::size_t k)
{
    std::erase_if(fragments, [](const Fragment &f) { return !(f.depth < 1.0F); });
    std::stable_sort(fragments.begin(), fragments.end(),
                     [](const Fragment &a, const Fragment &b) { return a.depth < b.depth; });
    if (fragments.size() > k)
        fragments.resize(k);
    return fragments;
}

std::uint32_t rgba8(const glm::vec4 &color)
{
    std::uint32_t bits = 0;
    for (int c = 0; c < 4; ++c)
        bits |= static_cast<std::uint32_t>(std::lround(color[c] * 255.0F)) << (8 * c);
    return bits;
}

constexpr float untouched = 123.0F; ///< In what a program must not write.

std::vector<glm::vec4> cleared(EntryLayout layout, int k)
{
    glm::vec4 empty(1.0F);
    if (layout == EntryLayout::rgbz)
        empty = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
    else if (layout == EntryLayout::packed)
        empty = glm::vec4(0.0F, 1.0F, 0.0F, 1.0F);
    std::vector<glm::vec4> entries(std::size_t(kb::entry_count(layout, k)), empty);
    // The places behind the last of k fragments belong to nobody.
    const int per_entry = kb::fragments_per_entry(layout);
    const int components = layout == EntryLayout::depth ? 1 : 4 / per_entry;
    const int used = (k - 1) % per_entry + 1;
    for (int c = used * components; c < 4; ++c)
        entries.back()[c] = untouched;
    return entries;
}

/// Compares the entries with the expected fragments, the places behind them with empty ones.
void expect_holds(EntryLayout layout, int k, const std::vector<glm::vec4> &entries,
                  const std::vector<Fragment> &expected)
{
    auto image = cleared(layout, k);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const Fragment &f = expected[i];
        const auto per_entry = static_cast<std::size_t>(kb::fragments_per_entry(layout));
        glm::vec4 &entry = image[i / per_entry];
        const int place = static_cast<int>(i % per_entry);
        switch (layout) {
        case EntryLayout::rgbz:
            entry = glm::vec4(glm::vec3(f.color), f.depth);
            break;
        case EntryLayout::packed:
            entry[2 * place] = std::bit_cast<float>(rgba8(f.color));
            entry[2 * place + 1] = f.depth;
            break;
        case EntryLayout::depth:
        case EntryLayout::depth4:
            entry[place] = f.depth;
            break;
        }
    }
    ASSERT_EQ(entries.size(), image.size());
    for (std::size_t e = 0; e < image.size(); ++e) {
        for (int c = 0; c < 4; ++c)
            ASSERT_EQ(std::bit_cast<std::uint32_t>(entries[e][c]),
                      std::bit_cast<std::uint32_t>(image[e][c]))
                << "entry " << e << " component " << c;
    }
}

class InsertionProgram : public testing::TestWithParam<EntryLayout>
{
};

TEST_P(InsertionProgram, KeepsTheNearestInStableOrder)
{
    std::mt19937 random(20261122);
    for (const int k : {1, 2, 3, 4, 5, 7, 8, 15, 16, 17, 31, 32, 63, 64, 127, 128, 256}) {
        if (k > kb::max_fragments(GetParam()))
            continue;
        const auto text = kb::make_insertion_program(GetParam(), k);
        ASSERT_TRUE(text) << text.error().message;
        const ArbInterpreter program(*text);
        for (const int depths : {1, 3, k, 1000}) {
            SCOPED_TRACE(fmt::format("k {} depths {}", k, depths));
            const auto fragments = random_fragments(std::size_t(2 * k + 5), depths, random);
            auto entries = cleared(GetParam(), k);
            for (std::size_t i = 0; i < fragments.size(); ++i) {
                program.run(fragments[i], entries);
                if (i % 7 == 0)
                    expect_holds(
                        GetParam(), k, entries,
                        nearest({fragments.begin(), fragments.begin() + std::ptrdiff_t(i) + 1},
                                std::size_t(k)));
            }
            expect_holds(GetParam(), k, entries, nearest(fragments, std::size_t(k)));
        }
    }
}

TEST_P(InsertionProgram, KillsWhatCannotEnter)
{
    const auto text = kb::make_insertion_program(GetParam(), 3);
    ASSERT_TRUE(text);
    const ArbInterpreter program(*text);
    auto entries = cleared(GetParam(), 3);
    EXPECT_FALSE(program.run({glm::vec4(0.5F), 1.0F}, entries));
    EXPECT_FALSE(program.run({glm::vec4(0.5F), std::nanf("")}, entries));
    EXPECT_TRUE(program.run({glm::vec4(0.5F), 0.5F}, entries));
    EXPECT_TRUE(program.run({glm::vec4(0.5F), 0.5F}, entries));
    EXPECT_TRUE(program.run({glm::vec4(0.5F), 0.5F}, entries));
    EXPECT_FALSE(program.run({glm::vec4(0.5F), 0.5F}, entries)) << "the fourth of equal depth";
    EXPECT_TRUE(program.run({glm::vec4(0.5F), 0.25F}, entries));
}

TEST_P(InsertionProgram, HasLimits)
{
    EXPECT_TRUE(kb::make_insertion_program(GetParam(), kb::max_fragments(GetParam())));
    EXPECT_FALSE(kb::make_insertion_program(GetParam(), kb::max_fragments(GetParam()) + 1));
    EXPECT_FALSE(kb::make_insertion_program(GetParam(), 0));
    EXPECT_FALSE(kb::make_insertion_program(GetParam(), -1));
}

INSTANTIATE_TEST_SUITE_P(Layouts, InsertionProgram,
                         testing::Values(EntryLayout::rgbz, EntryLayout::packed, EntryLayout::depth,
                                         EntryLayout::depth4),
                         [](const auto &info) { return std::string(kb::name_of(info.param)); });

TEST(InsertionProgramText, PackedOfThree)
{
    const auto text = kb::make_insertion_program(EntryLayout::packed, 3);
    ASSERT_TRUE(text);
    EXPECT_EQ(*text, R"(!!ARBfp1.0
OPTION MESA_kbuffer_program;
# Keeps the 3 nearest fragments, nearest first, equal depths as they arrive.
# Entries: RGBA8, depth, RGBA8, depth. Clear depths to 1.
TEMP t, new, p0, p1;
SLT t.x, fragment.position.z, kbuffer[1].y;
SUB t.x, t.x, 0.5;
KIL t.x;
PK4UB new.xz, fragment.color;
MOV new.yw, fragment.position.z;
SLT p0, fragment.position.z, kbuffer[0].yyww;
CMP t, -p0, new, kbuffer[0];
MOV result.kbuffer[0].xy, t;
CMP result.kbuffer[0].zw, -p0.x, kbuffer[0].xyxy, t;
SLT p1, fragment.position.z, kbuffer[1].yyww;
CMP t, -p1, new, kbuffer[1];
CMP result.kbuffer[1].xy, -p0.w, kbuffer[0].zwzw, t;
END
)");
}

TEST(InsertionProgramText, InstructionsPerFragment)
{
    // Three to reject, and then what the layouts promise: 3 a fragment, 4 two fragments, 2 one
    // depth, 3 four depths; the first place saves one, the packing costs two.
    const auto count = [](EntryLayout layout, int k) {
        return ArbInterpreter(*kb::make_insertion_program(layout, k)).instruction_count();
    };
    EXPECT_EQ(count(EntryLayout::rgbz, 64), 3U + 2U + 3U * 64U - 1U);
    EXPECT_EQ(count(EntryLayout::packed, 64), 3U + 2U + 4U * 32U);
    EXPECT_EQ(count(EntryLayout::depth, 64), 3U + 2U * 64U);
    EXPECT_EQ(count(EntryLayout::depth4, 64), 3U + 3U * 16U);
}

/// Test of the test: insertion by swaps on strict less-than, which is not stable, must be caught.
TEST(InsertionProgramText, SwapChainIsNotStable)
{
    const ArbInterpreter swaps(R"(!!ARBfp1.0
OPTION MESA_kbuffer_program;
TEMP t, in, p, out;
MOV in.xyz, fragment.color;
MOV in.w, fragment.position.z;
SLT p.x, in.w, kbuffer[0].w;
CMP result.kbuffer[0], -p.x, in, kbuffer[0];
CMP out, -p.x, kbuffer[0], in;
SLT p.x, out.w, kbuffer[1].w;
CMP result.kbuffer[1], -p.x, out, kbuffer[1];
CMP out, -p.x, kbuffer[1], out;
SLT p.x, out.w, kbuffer[2].w;
CMP result.kbuffer[2], -p.x, out, kbuffer[2];
END
)");
    const std::vector<Fragment> fragments{
        {glm::vec4(0.1F), 0.5F}, {glm::vec4(0.2F), 0.5F}, {glm::vec4(0.3F), 0.25F}};
    auto entries = cleared(EntryLayout::rgbz, 3);
    for (const Fragment &f : fragments)
        swaps.run(f, entries);
    // 0.25 pushes the first 0.5 out of its place; the second one is not greater and stays before.
    EXPECT_FLOAT_EQ(entries[1].x, 0.2F);
    EXPECT_FLOAT_EQ(nearest(fragments, 3)[1].color.x, 0.1F);
}

} // namespace
