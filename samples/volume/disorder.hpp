// SPDX-License-Identifier: MIT
//
// Faces sorted by their centroids give the fragments of a pixel nearly in depth order; a k-buffer
// puts the rest in order if k is large enough. This is the arithmetic of how large that is.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kb
{

/// How many places late the fragment of a pixel's sequence that is the latest of all arrives, for
/// its rank in depth order.
///
/// A k-buffer keeps k fragments. Once it is full, each fragment that arrives makes the nearest of
/// k + 1 leave: that of rank r leaves when place r + k arrives, so it has to be there by then. A
/// k-buffer puts a sequence in order if, and only if, no fragment of it is more than k places late.
/// How early one arrives does not matter: it waits.
class SequenceMeter
{
public:
    /// `arrivals[r]` says when the fragment of rank r arrives: any numbers, all different.
    int displacement(std::span<const std::uint32_t> arrivals);

private:
    struct Fragment {
        std::uint32_t arrival;
        int rank;
    };
    std::vector<Fragment> fragments_; ///< Kept for its memory.
};

/// The disorder of a picture.
class Disorder
{
public:
    /// A pixel by the arrivals of its fragments, as in SequenceMeter; one without is left out.
    void add_pixel(std::span<const std::uint32_t> arrivals);

    std::uint64_t pixels() const { return pixels_; }
    std::uint64_t fragments() const { return fragments_; }
    int deepest() const { return deepest_; } ///< Most fragments of a pixel.

    /// The largest of a fragment, and the least k that puts all pixels in order.
    int displacement() const;

    /// Part of the pixels that a k-buffer does not put in order.
    double share_wrong(int k) const;

private:
    SequenceMeter meter_;
    std::uint64_t pixels_ = 0;
    std::uint64_t fragments_ = 0;
    int deepest_ = 0;
    std::vector<std::uint64_t> pixels_by_displacement_;
};

} // namespace kb
