// SPDX-License-Identifier: MIT

#pragma once

#include <nlohmann/json.hpp>

namespace kb::bench
{

/// What a reader must know of this machine to make sense of its times.
nlohmann::json describe_machine();

} // namespace kb::bench
