// SPDX-License-Identifier: MIT

#pragma once

#include "lib/result.hpp"

#include <filesystem>
#include <fstream>
#include <string>

namespace kb
{

/// A file that can be read from its beginning. An error does not name it.
Result<std::ifstream> open_file(const std::filesystem::path &path);

/// All bytes of a file. An error does not name the file.
Result<std::string> read_file(const std::filesystem::path &path);

} // namespace kb
