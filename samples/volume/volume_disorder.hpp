// SPDX-License-Identifier: MIT

#pragma once

#include "lib/app/long_work.hpp"
#include "volume/disorder_report.hpp"
#include "volume/sorted_faces.hpp"
#include "volume/volume_options.hpp"
#include "volume/volume_scene.hpp"

namespace kb
{

/// `faces` made the picture as they are sorted; they may be the scene's own ones or pieces of them.
/// Its colors are compared with the exact picture of the scene's own faces, unless it is exact
/// itself. An error if `go_on` ends it after a pass.
Result<DisorderReport> measure_disorder(const Gl &gl, const VolumeOptions &options,
                                        const VolumeScene &scene, const SortedFaces &faces,
                                        const ImageRgbaF &picture, const GoOn &go_on);

} // namespace kb
