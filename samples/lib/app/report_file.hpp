// SPDX-License-Identifier: MIT
//
// Reports for programs (--json): what all samples tell alike, and the file.

#pragma once

#include "lib/result.hpp"
#include "lib/scene/camera.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace kb
{

nlohmann::json to_json(const OrbitCamera &camera);

/// Writes the report; an empty path is none. Bytes that are no UTF-8, as the name of a file may
/// have, are replaced.
Status write_report(const std::filesystem::path &path, const nlohmann::json &report);

} // namespace kb
