// SPDX-License-Identifier: MIT
//
// Files that a program writes. A regular file is replaced as a whole or not at all; a device, a
// pipe or a socket is opened and written; - is the standard output. Symbolic links are followed.

#pragma once

#include "lib/result.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace kb
{

/// A file that is going to be written, and its format.
struct OutputFile {
    std::filesystem::path file; ///< Empty if it is not wanted.
    std::string_view ending;    ///< That names of this format have, as ".png"; empty: plain text.
};

/// Finds out before any work whether the files can be written: a name that ends in another format's
/// ending is an error, as is the standard output for two of them. If it is for one of them, what is
/// printed to stdout from here on goes to stderr.
Status prepare_outputs(std::span<const OutputFile> files);

/// Writes the file. The new one gets the permissions of a regular file that was there. On an error
/// a regular file is what it was before, or is not there.
Status write_file(const std::filesystem::path &path, std::span<const std::byte> bytes);

} // namespace kb
