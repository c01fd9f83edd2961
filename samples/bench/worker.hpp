// SPDX-License-Identifier: MIT
//
// The process that draws: answers the parent's requests with one GL context of one driver.

#pragma once

namespace kb::bench
{

/// Answers requests from stdin on stdout until they end; returns the exit status.
///
/// Each request is {"do": ...}:
///   hello   -> {"driver", "kbuffer_program"}
///   scene   {"name", "dragon", "width", "height"} -> {"triangles", "note"}
///   capture {"ks", "paths"} -> {"fragments", "depth_complexity", "covered_pixels"}
///           writes the exact image of each k to a PFM file
///   method  {"method", "variant", "k"} -> {"id", "passes", "bytes_per_pixel"}
///   frame   {"id"} -> {"ms"}
///   image   {"id", "path"} -> {}
///           writes the image to a PFM file
/// A request that cannot be met is answered by {"error"}, or {"bad_input"} if that is the reason.
int work();

} // namespace kb::bench
