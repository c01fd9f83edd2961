// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/image.hpp"
#include "tests/support/process.hpp"
#include "tests/support/temp_directory.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace kb::test
{

/// What one run of the sample `transparency` wrote.
struct Rendering {
    ImageRgbaF floats;
    ImageRgba8 bytes;
    std::vector<ImageRgbaF> colors; ///< Of the layers; alpha is 1.
    std::vector<ImageRgbaF> depths; ///< The depth is in all of red, green and blue.
    std::string float_file;         ///< The file of the floats, byte for byte.
};

/// Tests that run the sample in processes of their own, on the Mesa of a prefix.
class PictureTest : public testing::Test
{
protected:
    /// Runs `transparency` with output to files. A failure is the test's.
    Rendering render(const std::string &prefix, const std::vector<std::string> &arguments,
                     const std::map<std::string, std::string> &environment = {});

    /// The largest difference, and 1 if the sizes differ.
    static double max_difference(const ImageRgbaF &a, const ImageRgbaF &b);

    TempDirectory directory_;

private:
    int renderings_ = 0;
};

/// A picture of write_plane_stack and the depths of its layers.
struct LayeredPicture {
    const ImageRgbaF &picture;
    const std::vector<ImageRgbaF> &depths;
};

/// Two drivers agree on a stack of as many planes as layers, away from the planes' edges.
void expect_agreement_inside_of_faces(const LayeredPicture &a, const LayeredPicture &b,
                                      std::size_t layers);

/// Skips a test that compares with stock Mesa where there is none.
#define KB_NEED_STOCK()                                                                            \
    if (kb::test::stock_prefix().empty())                                                          \
    GTEST_SKIP() << "KBUFFER_STOCK_PREFIX is not set"

} // namespace kb::test
