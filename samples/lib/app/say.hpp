// SPDX-License-Identifier: MIT

#pragma once

#include <string_view>

namespace kb
{

/// Writes a line to the standard output, at once: whoever reads it through a pipe has it before
/// long work begins, and keeps it if that is broken off. Nobody reading any more is no error.
void say(std::string_view line);

/// Writing to a pipe that nobody reads any more does not end the program.
void outlive_readers();

} // namespace kb
