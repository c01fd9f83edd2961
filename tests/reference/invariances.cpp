// SPDX-License-Identifier: MIT

#include "invariances.hpp"

namespace kb::reference
{

std::span<const Invariance> invariances()
{
    return {};
}

std::uint64_t digest_of(const Observation &seen, std::uint64_t digest)
{
    // FNV-1a.
    const auto add = [&digest](const auto &values) {
        for (const std::byte byte : std::as_bytes(std::span(values)))
            digest = (digest ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3U;
    };
    for (const Pass &pass : seen.passes) {
        add(pass.depth);
        add(pass.composite);
        for (const auto &colors : pass.colors)
            add(colors);
    }
    return digest;
}

} // namespace kb::reference
