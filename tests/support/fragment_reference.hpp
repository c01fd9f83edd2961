// SPDX-License-Identifier: MIT
//
// A reference that shares no code with the drivers' k-buffers. Stock Mesa draws every triangle
// alone (fragment-dump), which gives all fragments with their depth and color. Here they are sorted
// by std::stable_sort and composed in double precision.

#pragma once

#include "lib/io/image.hpp"
#include "tests/support/temp_directory.hpp"

#include <glm/vec4.hpp>

#include <string>
#include <vector>

namespace kb::test
{

struct Fragment {
    float depth;
    glm::vec4 color;
};

struct FragmentSource {
    std::string mesh;
    int side = 64;       ///< Of the picture, in pixels.
    float alpha = -1.0F; ///< Of all fragments; negative: that of the vertices.
    std::string driver = "llvmpipe";
    std::string depth_format = "32f";
    int samples = 0;
};

class FragmentReference
{
public:
    /// Draws with stock Mesa. A failure is the test's.
    FragmentReference(const TempDirectory &directory, const FragmentSource &source);

    /// Puts the fragments of each sample in the order of a depth function: "less", "lequal",
    /// "greater" or "gequal".
    void sort(const std::string &func = "less");

    /// The fragments of a sample, at first in the order of drawing. Top row first, the samples of a
    /// pixel in a row.
    const std::vector<Fragment> &at(std::size_t sample) const { return fragments_[sample]; }
    std::size_t sample_count() const { return fragments_.size(); }
    std::size_t deepest() const;
    std::size_t fragment_count() const;

    /// The first k fragments in their order over (or, if they come farthest first, in the reverse
    /// order over) white; the average of a pixel's samples.
    ImageRgbaF compose(std::size_t k, bool farthest_first = false) const;

private:
    int side_;
    std::size_t samples_;
    std::vector<std::vector<Fragment>> fragments_;
};

} // namespace kb::test
