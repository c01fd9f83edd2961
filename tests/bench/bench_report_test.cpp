// SPDX-License-Identifier: MIT
//
// What the study computes apart from drawing: exact compositing, the plan of runs, the report.

#include "bench/exact.hpp"
#include "bench/methods.hpp"
#include "bench/report.hpp"
#include "bench/worker_process.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace kb::bench
{

TEST(BenchExact, CompositesTheFirstKFrontToBack)
{
    std::array fragments{Fragment{{0.0F, 1.0F, 0.0F, 0.5F}, 0.75F},
                         Fragment{{1.0F, 0.0F, 0.0F, 0.5F}, 0.25F},
                         Fragment{{0.0F, 0.0F, 1.0F, 1.0F}, 0.5F}};
    sort_by_depth(fragments);
    // Red, then opaque blue: 0.5 red + 0.5 blue.
    EXPECT_EQ(composite(fragments, 2), glm::dvec3(0.5, 0.0, 0.5));
    EXPECT_EQ(composite(fragments, 64), glm::dvec3(0.5, 0.0, 0.5));
    EXPECT_EQ(composite(fragments, 1), glm::dvec3(0.5, 0.0, 0.0) + 0.5 * background);
    EXPECT_EQ(composite(fragments, 0), glm::dvec3(1.0, 0.0, 0.0));
    EXPECT_EQ(composite({}, 0), background);
    EXPECT_EQ(composite({}, 8), background);
}

TEST(BenchExact, EqualDepthsStayInOrderOfArrival)
{
    std::vector<Fragment> fragments;
    for (int i = 0; i < 100; ++i)
        fragments.push_back({glm::vec4(static_cast<float>(i)), i % 2 == 0 ? 0.5F : 0.25F});
    sort_by_depth(fragments);
    for (int i = 0; i < 50; ++i) {
        const auto place = static_cast<std::size_t>(i);
        EXPECT_EQ(fragments[place].color.r, static_cast<float>(2 * i + 1));
        EXPECT_EQ(fragments[50 + place].color.r, static_cast<float>(2 * i));
    }
}

static std::multiset<std::string> labels(const std::vector<Run> &runs)
{
    std::multiset<std::string> result;
    for (const Run &run : runs)
        result.insert(run.method + "/" + run.driver + "/" + std::to_string(run.k));
    return result;
}

TEST(BenchPlan, CombinesMethodsAndKs)
{
    const std::vector<std::string> names{"fbfetch", "kbuffer-program"};
    const std::vector ks{4, 32};
    EXPECT_EQ(labels(plan_runs(names, ks)),
              (std::multiset<std::string>{"zbuffer/stock/0", "fbfetch/stock/4",
                                          "kbuffer-program/ours/4", "kbuffer-program/ours/32"}));
}

TEST(BenchPlan, KeepsEachMethodsLimit)
{
    const std::vector<std::string> names{"fbfetch"};
    const std::vector ks{16, 17};
    EXPECT_EQ(labels(plan_runs(names, ks)),
              (std::multiset<std::string>{"zbuffer/stock/0", "fbfetch/stock/16"}));
}

TEST(BenchPlan, LabelsTellAllRunsApart)
{
    std::vector<std::string> names;
    for (const Method &method : methods)
        names.emplace_back(method.name);
    const std::vector ks{4, 8};
    std::set<std::string> seen;
    for (const auto &run : plan_runs(names, ks))
        EXPECT_TRUE(seen.insert(label(run)).second) << label(run);
    EXPECT_EQ(label({"zbuffer", "", "stock", "", 0}), "zbuffer");
    EXPECT_EQ(label({"k-plus", "unlocked", "stock", "", 8}), "k-plus-unlocked-8");
}

static Row make_row(const char *method, int k, double ms)
{
    Row row;
    row.scene = "quads";
    row.method = method;
    row.driver = "stock";
    row.k = k;
    row.ms = {ms, ms - 1.0, ms + 1.0};
    row.ratio = {ms / 2.0, ms / 2.5, ms / 1.5}; // z-buffering takes 2 ms
    return row;
}

TEST(BenchReport, JsonHasExactlyTheFieldsOfTheSchema)
{
    const std::vector rows{make_row("zbuffer", 0, 2.0)};
    const auto document = to_json({{"processor", "x"}}, rows);
    EXPECT_EQ(document.size(), 2U);
    EXPECT_EQ(document.at("machine").at("processor"), "x");
    std::set<std::string> fields;
    for (const auto &[name, value] : document.at("results").at(0).items())
        fields.insert(name);
    EXPECT_EQ(
        fields,
        (std::set<std::string>{
            "scene",       "method",       "variant",         "driver",  "k",        "passes",
            "triangles",   "fragments",    "ms_median",       "ms_p5",   "ms_p95",   "ratio_median",
            "ratio_p5",    "ratio_p95",    "bytes_per_pixel", "err_max", "err_rmse", "err_share",
            "err_all_max", "err_all_rmse", "err_all_share"}));
    EXPECT_EQ(document["results"][0]["ms_p95"], 3.0);
}

TEST(BenchReport, TableHasRatiosToBothBases)
{
    std::vector rows{make_row("zbuffer", 0, 2.0), make_row("fbfetch", 4, 10.0),
                     make_row("fbfetch", 8, 40.0), make_row("kbuffer-program", 4, 5.0)};
    rows.back().driver = "ours";
    const std::string table = to_table(rows);
    const std::string last = table.substr(table.rfind("quads"));
    EXPECT_NE(last.find(" 2.50 "), std::string::npos) << last; // to z-buffering
    EXPECT_NE(last.find(" 0.50 "), std::string::npos) << last; // to framebuffer fetch of this k
}

TEST(BenchWorker, MessagesSurviveTheStream)
{
    const File stream(std::tmpfile());
    const nlohmann::json message{{"do", "scene"}, {"name", "line\nbreak"}};
    write_message(stream.get(), message);
    std::rewind(stream.get());
    EXPECT_EQ(read_message(stream.get()), message);
    EXPECT_TRUE(read_message(stream.get()).is_null());
}

TEST(BenchWorker, APrefixWithoutMesaIsAnError)
{
    EXPECT_THROW(static_cast<void>(library_folder("/no/such/prefix")), std::runtime_error);
}

} // namespace kb::bench
