// SPDX-License-Identifier: MIT

#pragma once

#include "volume/preintegration.hpp"

namespace kb
{

/// How the k-buffer program finds what a segment adds.
struct SegmentLookup {
    /// 0: by one nearest texel of a PackedSegmentTexture. That is all that segments in small cells
    /// need, and fastest. Else segments are cut into as many equal parts, each looked up between
    /// the texels of SegmentTextures: so the table's differences are small ones only, and what it
    /// neglects, that extinction bends within opaque segments, becomes little.
    int parts = 0;

    bool interpolates() const { return parts > 0; }
};

/// Of the table of the lookup's texture. A nearest texel of 2049 means is off by 1/4096 of the
/// range of scalars. Parts have differences up to 1 / parts.
inline TableSize table_size(SegmentLookup lookup)
{
    if (!lookup.interpolates())
        return {2049, 129};
    return lookup.parts == 1 ? TableSize{4097, 129} : TableSize{8193, 65, 1.0 / lookup.parts};
}

} // namespace kb
