// SPDX-License-Identifier: MIT
//
// Fuzzes sequences of GL commands about both extensions. An input is a sequence of records of
// eight bytes: the command, then its arguments. Each input gets contexts of its own. Besides what
// the sanitizers and assertions find:
//
//   - no command gives an error that GL does not give it;
//   - a draw, and FIRST_LAYER, is an error exactly if the specifications say so;
//   - a draw that is an error changes no texel and no OVERFLOW;
//   - peeling keeps sorted layers sorted, moves none back, and never loses a fragment silently.

#include "fuzz/draws/machine.hpp"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
    // Set by `scripts/fuzz --print`.
    kb::fuzz::Machine machine(std::getenv("KBUFFER_FUZZ_PRINT") ? stdout : nullptr);

    machine.run({data, size});
    return 0;
}
