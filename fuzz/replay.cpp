// SPDX-License-Identifier: MIT
//
// The fuzzer's inputs once more, without the fuzzer: `fuzz-draws FILE|FOLDER...` runs the
// target on each file, in the order of their names. A target that is linked with libFuzzer has a
// main of its own instead of this one.

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);

namespace
{

std::vector<std::filesystem::path> files_of(const std::vector<std::filesystem::path> &arguments)
{
    std::vector<std::filesystem::path> files;
    for (const auto &argument : arguments) {
        if (!std::filesystem::is_directory(argument)) {
            files.push_back(argument);
            continue;
        }
        for (const auto &entry : std::filesystem::directory_iterator(argument))
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace

int main(int argc, char **argv)
{
    const auto files = files_of({argv + 1, argv + argc});
    if (files.empty()) {
        fmt::print(stderr, "Usage: {} FILE|FOLDER...\n", argv[0]);
        return 2;
    }
    for (const auto &path : files) {
        std::ifstream file(path, std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(file)), {});
        if (!file) {
            fmt::print(stderr, "cannot read {}\n", path.string());
            return 1;
        }
        // Before the run: the last name is that of the input that ended the process.
        fmt::print("{}\n", path.filename().string());
        std::fflush(stdout);
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t *>(bytes.data()), bytes.size());
    }
    return 0;
}
