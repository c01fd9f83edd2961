// SPDX-License-Identifier: MIT

#include "volume/transfer_function.hpp"

#include "tests/support/temp_directory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

namespace
{

using kb::parse_transfer_function;
using kb::TransferFunction;

constexpr kb::ScalarRange unit{};

std::string error_of(const std::string &text)
{
    const auto function = parse_transfer_function(text, unit);
    return function ? "none" : function.error().message;
}

TEST(TransferFunction, IsLinearBetweenPointsAndConstantBeyond)
{
    const auto function = parse_transfer_function("0.25 0 1 0 2\n0.75 1 0 0.5 4\n", unit);
    ASSERT_TRUE(function);
    EXPECT_EQ(function->at(0.5F).color, glm::vec3(0.5F, 0.5F, 0.25F));
    EXPECT_EQ(function->at(0.5F).extinction, 3.0F);
    EXPECT_EQ(function->at(-1.0F).extinction, 2.0F);
    EXPECT_EQ(function->at(0.0F).color, glm::vec3(0.0F, 1.0F, 0.0F));
    EXPECT_EQ(function->at(7.0F).extinction, 4.0F);
}

TEST(TransferFunction, StepsWhereTwoPointsHaveOneValue)
{
    const auto function =
        parse_transfer_function("0 0 0 0 1\n0.5 0 0 0 1\n0.5 1 1 1 9\n1 1 1 1 9\n", unit);
    ASSERT_TRUE(function);
    EXPECT_EQ(function->at(std::nextafter(0.5F, 0.0F)).extinction, 1.0F);
    EXPECT_EQ(function->at(0.5F).extinction, 9.0F);
}

TEST(TransferFunction, IsInfiniteBesideAnInfinitePointAndNeverNan)
{
    const auto function = parse_transfer_function("0 0 0 0 1\n1 0 0 0 inf\n", unit);
    ASSERT_TRUE(function);
    EXPECT_EQ(function->at(0.0F).extinction, 1.0F);
    for (const float value : {1e-6F, 0.5F, 1.0F, 2.0F})
        EXPECT_EQ(function->at(value).extinction, std::numeric_limits<float>::infinity()) << value;
}

TEST(TransferFunction, ValuesAreTheFieldsUnlessNormalized)
{
    const kb::ScalarRange range{100.0F, 300.0F};
    const auto of_field = parse_transfer_function("150 0 0 0 5\n", range);
    ASSERT_TRUE(of_field);
    EXPECT_EQ(of_field->points().front().value, 0.25F);
    const auto normalized = parse_transfer_function("normalized\n0.25 0 0 0 5\n", range);
    ASSERT_TRUE(normalized);
    EXPECT_EQ(normalized->points().front().value, 0.25F);
}

TEST(TransferFunction, ValuesAreTheFieldsWithItsOffset)
{
    // In floats of 101325.01 to 101325.03 nothing would be left of them.
    const kb::ScalarRange range{0.0F, 0.04F, 101325.0};
    const auto function = parse_transfer_function("101325.01 0 0 0 5\n101325.03 1 1 1 5\n", range);
    ASSERT_TRUE(function) << function.error().message;
    EXPECT_NEAR(function->points()[0].value, 0.25, 1e-6);
    EXPECT_NEAR(function->points()[1].value, 0.75, 1e-6);
    const auto wrong = parse_transfer_function("101325.03 0 0 0 5\n101325.01 1 1 1 5\n", range);
    EXPECT_EQ(wrong.error().message, "transfer function, point 2: values must ascend, 101325.01 "
                                     "follows 101325.03");
}

TEST(ScalarRange, IsDescribedInTheFieldsUnits)
{
    const auto describe = [](std::vector<float> values, double offset) {
        return kb::describe_field({.name = "p", .values = std::move(values), .offset = offset});
    };
    EXPECT_EQ(describe({0.0F, 0.04F, 0.01F}, 101325.0), "field 'p' from 101325 to 101325.04");
    EXPECT_EQ(describe({-1.0F, 0.1F}, 0.0), "field 'p' from -1 to 0.1");
    EXPECT_EQ(describe({0.0F, 0.0F}, 273.15), "field 'p' is 273.15 everywhere");
    const kb::ScalarRange flat = kb::range_of(std::vector<float>{1e9F, 1e9F});
    EXPECT_FALSE(flat.varies);
    EXPECT_GT(flat.high, flat.low) << "there is nothing to divide by else";
    EXPECT_EQ(kb::list_fields(std::vector<kb::ScalarField>{
                  {.name = "v", .values = {1.0F, 2.0F}, .offset = 0.0, .components = 3},
                  {.name = "T", .values = {}, .offset = 0.0, .components = 1, .fault = "no"}}),
              "v: magnitude of 3 components, from 1 to 2\nT: cannot be drawn: no\n");
}

TEST(TransferFunction, CommentsAndBlankLinesAreNothing)
{
    const auto function = parse_transfer_function("# a comment\n\n 0 0 0 0 1 # one\r\n\t\n", unit);
    ASSERT_TRUE(function) << function.error().message;
    EXPECT_EQ(function->points().size(), 1U);
}

TEST(TransferFunction, BadOnesAreSaidToBe)
{
    EXPECT_EQ(error_of(""), "the transfer function has no points");
    EXPECT_EQ(error_of("normalized\n# nothing\n"), "the transfer function has no points");
    EXPECT_EQ(error_of("0 0 0 0 1\n1 0 0 0\n"),
              "transfer function, line 2: value red green blue extinction are wanted, not 4 words");
    EXPECT_EQ(error_of("0 0 0 0 1 2\n"),
              "transfer function, line 1: value red green blue extinction are wanted, not 6 words");
    EXPECT_EQ(error_of("0 0 zero 0 1\n"), "transfer function, line 1: zero is not a number");
    EXPECT_EQ(error_of("0 0 0 0 1x\n"), "transfer function, line 1: 1x is not a number");
    EXPECT_EQ(error_of("0.5 0 0 0 1\n0.25 0 0 0 1\n"),
              "transfer function, point 2: values must ascend, 0.25 follows 0.5");
    EXPECT_EQ(error_of("nan 0 0 0 1\n"), "transfer function, point 1: the value nan is not finite");
    EXPECT_EQ(error_of("inf 0 0 0 1\n"), "transfer function, point 1: the value inf is not finite");
    EXPECT_EQ(error_of("0 0 1.5 0 1\n"), "transfer function, point 1: 1.5 is no color from 0 to 1");
    EXPECT_EQ(error_of("0 0 0 -1 1\n"), "transfer function, point 1: -1 is no color from 0 to 1");
    EXPECT_EQ(error_of("0 nan 0 0 1\n"), "transfer function, point 1: nan is no color from 0 to 1");
    EXPECT_EQ(error_of("0 0 0 0 -2\n"), "transfer function, point 1: -2 is no extinction from 0");
    EXPECT_EQ(error_of("0 0 0 0 nan\n"), "transfer function, point 1: nan is no extinction from 0");
    EXPECT_EQ(error_of("normalized twice\n"),
              "transfer function, line 1: nothing may stand beside the word normalized");
    EXPECT_EQ(error_of("0 0 0 0 1\nnormalized\n"),
              "transfer function, line 2: value red green blue extinction are wanted, not 1 words");
}

TEST(TransferFunction, FilesThatCannotBeReadAreSaidToBe)
{
    const kb::test::TempDirectory directory;
    const auto missing = kb::load_transfer_function(directory / "none.txt", unit);
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message.find("cannot read"), std::string::npos);
    EXPECT_FALSE(kb::load_transfer_function(directory / ".", unit));
    std::ofstream(directory / "bad.txt") << "1 2\n";
    const auto bad = kb::load_transfer_function(directory / "bad.txt", unit);
    ASSERT_FALSE(bad);
    EXPECT_NE(bad.error().message.find("bad.txt: transfer function, line 1"), std::string::npos);
}

TEST(TransferFunction, BuiltInOnesAreFoundByName)
{
    for (const std::string_view name : kb::transfer_function_names()) {
        const auto function = kb::find_transfer_function(name);
        ASSERT_TRUE(function) << name;
        EXPECT_EQ(function->points().front().value, 0.0F);
        EXPECT_EQ(function->points().back().value, 1.0F);
    }
    EXPECT_FALSE(kb::find_transfer_function("fog"));
}

} // namespace
