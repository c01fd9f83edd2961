// SPDX-License-Identifier: MIT
//
// What must not change the layers of a scene, or only in a known way.

#pragma once

#include "tests/reference/check.hpp"
#include "tests/reference/random_scene.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace kb::reference
{

struct Invariance {
    const char *name;
    /// What breaks it in the scene of a seed, if anything does.
    Result<std::optional<std::string>> (*broken)(SceneDrawer &drawer, std::uint64_t seed,
                                                 const SceneLimits &limits);
};

std::span<const Invariance> invariances();

/// Folds the bits of all layers and composites into a number.
std::uint64_t digest_of(const Observation &seen, std::uint64_t digest);

} // namespace kb::reference
