// SPDX-License-Identifier: MIT
//
// What the reports of volume and isosurface have in common.

#pragma once

#include "volume/disorder_report.hpp"
#include "volume/scalar_range.hpp"

#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>

namespace kb
{

/// For a picture by a k-buffer in which k fragments wait.
nlohmann::json to_json(const DisorderReport &report, int k);

nlohmann::json to_json(glm::dvec3 v);

/// Lowest and highest value, in the units of the field.
nlohmann::json to_json(const ScalarRange &range);

} // namespace kb
