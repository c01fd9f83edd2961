// SPDX-License-Identifier: MIT

#include "lib/io/file.hpp"

#include <utility>
#include <vector>

namespace kb
{

Result<std::ifstream> open_file(const std::filesystem::path &path)
{
    std::error_code code;
    if (!std::filesystem::exists(path, code))
        return Error{"no such file"};
    if (std::filesystem::is_directory(path, code))
        return Error{"it is a directory"};
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return Error{"it cannot be opened"};
    return {std::move(file)};
}

Result<std::string> read_file(const std::filesystem::path &path)
{
    auto file = open_file(path);
    if (!file)
        return file.error();
    std::string content;
    std::vector<char> block(1U << 20U);
    while (file->read(block.data(), static_cast<std::streamsize>(block.size())), file->gcount() > 0)
        content.append(block.data(), static_cast<std::size_t>(file->gcount()));
    if (file->bad())
        return Error{"it cannot be read"};
    return content;
}

} // namespace kb
