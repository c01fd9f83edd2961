// SPDX-License-Identifier: MIT

#pragma once

#include "isosurface/isosurface_renderer.hpp"
#include "volume/disorder_report.hpp"

#include <span>

namespace kb
{

/// How far from depth order the fragments of a stream come, and what that did to the colors of a
/// picture of its surfaces. The stream is sorted for the camera. The exact picture is that of a
/// k-buffer large enough for all fragments to leave it in order: see SequenceMeter. An error if
/// `go_on` ends it after a pass.
Result<DisorderReport> measure_disorder(const Gl &gl, const IsosurfaceSettings &settings,
                                        const FragmentStream &stream, const OrbitCamera &camera,
                                        std::span<const IsoValue> values, const ImageRgbaF &picture,
                                        const GoOn &go_on = {});

} // namespace kb
