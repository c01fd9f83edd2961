// SPDX-License-Identifier: MIT

#pragma once

#include "result.hpp"

#include <filesystem>
#include <string>

namespace kb
{

/// All bytes of a file. An error does not name the file.
Result<std::string> read_file(const std::filesystem::path &path);

} // namespace kb
