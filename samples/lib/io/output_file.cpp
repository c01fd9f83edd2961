// SPDX-License-Identifier: MIT

#include "lib/io/output_file.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace kb
{

namespace
{

/// What a name stands for.
struct Target {
    std::filesystem::path file; ///< Symbolic links have been followed.
    int descriptor = -1;        ///< Of an open file, if it is one: - or /dev/stdout.
    bool replaced = false;      ///< It is a regular file, or none yet.
    std::optional<mode_t> mode; ///< Its permissions, if it is there.
    uid_t owner = 0;
    gid_t group = 0;
};

std::string display(const std::filesystem::path &path)
{
    return path == "-" ? "the standard output" : path.string();
}

Error unwritable(const std::filesystem::path &path, std::string_view why)
{
    return Error{fmt::format("cannot write {}: {}", display(path), why)};
}

Error unwritable(const std::filesystem::path &path)
{
    return unwritable(path, std::strerror(errno));
}

std::filesystem::path folder_of(const std::filesystem::path &file)
{
    return file.has_parent_path() ? file.parent_path() : ".";
}

/// The number that a file in /proc/self/fd, which is also /dev/fd, has as its name, or -1.
int descriptor_named(const std::filesystem::path &file, const std::filesystem::path &folder)
{
    if (folder != fmt::format("/proc/{}/fd", getpid()))
        return -1;
    const std::string name = file.filename();
    int number = -1;
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), number);
    return code == std::errc() && end == name.data() + name.size() ? number : -1;
}

/// Follows the links by hand: one may lead to a file that is not there yet, or to one that is open
/// here, for which its name says less than its number.
Result<Target> find_target(const std::filesystem::path &path)
{
    constexpr int most_links = 40; // As the kernel has it.
    Target target;
    target.file = path;
    if (path == "-") {
        target.descriptor = STDOUT_FILENO;
        return target;
    }
    std::error_code code;
    for (int links = 0;; ++links) {
        if (!target.file.has_filename() || target.file.filename() == "." ||
            target.file.filename() == "..")
            return unwritable(path, std::filesystem::is_directory(target.file, code)
                                        ? "it is a directory"
                                        : "it is not the name of a file");
        const auto folder = std::filesystem::canonical(folder_of(target.file), code);
        if (code || !std::filesystem::is_directory(folder, code))
            return unwritable(
                path, fmt::format("there is no directory {}", folder_of(target.file).string()));
        target.descriptor = descriptor_named(target.file, folder);
        if (target.descriptor >= 0)
            return target;
        if (!std::filesystem::is_symlink(target.file, code))
            break;
        if (links == most_links)
            return unwritable(path, std::strerror(ELOOP));
        target.file = folder / std::filesystem::read_symlink(target.file, code);
    }
    struct stat there;
    if (stat(target.file.c_str(), &there) != 0) {
        if (errno != ENOENT)
            return unwritable(path);
        target.replaced = true;
        return target;
    }
    if (S_ISDIR(there.st_mode))
        return unwritable(path, "it is a directory");
    target.replaced = S_ISREG(there.st_mode);
    target.mode = there.st_mode & mode_t{07777};
    target.owner = there.st_uid;
    target.group = there.st_gid;
    return target;
}

Status check_access(const std::filesystem::path &path, const Target &target)
{
    if (target.descriptor >= 0) {
        const int flags = fcntl(target.descriptor, F_GETFL);
        if (flags < 0)
            return unwritable(path);
        if ((flags & O_ACCMODE) == O_RDONLY)
            return unwritable(path, "it is open for reading only");
        return ok;
    }
    if (target.mode && access(target.file.c_str(), W_OK) != 0)
        return unwritable(path);
    if (target.replaced && access(folder_of(target.file).c_str(), W_OK | X_OK) != 0)
        return unwritable(
            path, fmt::format("{}: {}", folder_of(target.file).string(), std::strerror(errno)));
    return ok;
}

/// Formats that people expect a program to choose by the name of a file.
constexpr std::array known_endings{
    ".avif", ".bmp", ".csv", ".dds", ".exr", ".gif", ".hdr",  ".html", ".jpeg", ".jpg",
    ".json", ".pbm", ".pdf", ".pfm", ".pgm", ".png", ".pnm",  ".ppm",  ".ps",   ".svg",
    ".tga",  ".tif", ".jxl", ".vtk", ".xml", ".jp2", ".tiff", ".webp", ".yaml"};

Status check_ending(const OutputFile &output)
{
    std::string ending = output.file.extension();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == output.ending || std::ranges::find(known_endings, ending) == known_endings.end())
        return ok;
    return unwritable(output.file,
                      output.ending.empty()
                          ? fmt::format("it is plain text, not a {} file", ending)
                          : fmt::format("it is a {} file, not a {} file", output.ending, ending));
}

class Descriptor
{
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;

    explicit operator bool() const { return number_ >= 0; }
    int number() const { return number_; }

    /// False, with errno, if something written before turns out to be lost.
    bool close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0; }

private:
    int number_;
};

/// False, with errno, if not all of it could be written.
bool write_all(int descriptor, std::span<const std::byte> bytes)
{
    while (!bytes.empty()) {
        const ssize_t count = write(descriptor, bytes.data(), bytes.size());
        if (count < 0 && errno != EINTR)
            return false;
        bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
    return true;
}

/// A new file beside the one that it takes the place of when it is whole; else it is removed.
class Replacement
{
public:
    explicit Replacement(const Target &target) : target_(target), open_(create()) {}
    ~Replacement()
    {
        if (!file_.empty())
            unlink(file_.c_str());
    }
    Replacement(const Replacement &) = delete;
    Replacement &operator=(const Replacement &) = delete;

    /// False, with errno, on any error.
    bool write(std::span<const std::byte> bytes)
    {
        if (!open_ || !keep_permissions() || !write_all(open_.number(), bytes) || !open_.close() ||
            rename(file_.c_str(), target_.file.c_str()) != 0)
            return false;
        file_.clear();
        return true;
    }

private:
    int create()
    {
        for (int i = 0; i < 100; ++i) {
            const auto file =
                folder_of(target_.file) / fmt::format(".kbuffer-{}-{}.part", getpid(), i);
            const int number = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (number >= 0)
                file_ = file;
            if (number >= 0 || errno != EEXIST)
                return number;
        }
        return -1;
    }

    /// The owner is kept as well by root, who alone can.
    bool keep_permissions() const
    {
        if (!target_.mode)
            return true;
        if (fchown(open_.number(), target_.owner, target_.group) != 0 && errno != EPERM)
            return false;
        return fchmod(open_.number(), *target_.mode) == 0;
    }

    const Target &target_;
    std::filesystem::path file_; ///< Empty if there is none, or none any more.
    Descriptor open_;
};

} // namespace

Status prepare_outputs(std::span<const OutputFile> files)
{
    int on_standard_output = 0;
    std::map<std::filesystem::path, std::filesystem::path> names; // Of what will be replaced
    for (const OutputFile &output : files) {
        if (output.file.empty())
            continue;
        const auto target = find_target(output.file);
        if (!target)
            return target.error();
        if (target->replaced) {
            if (auto checked = check_ending(output); !checked)
                return checked;
            if (const auto other = names.try_emplace(target->file, output.file); !other.second)
                return Error{fmt::format("{} and {} are one file, to which two outputs would go",
                                         other.first->second.string(), output.file.string())};
        }
        if (auto checked = check_access(output.file, *target); !checked)
            return checked;
        on_standard_output += target->descriptor == STDOUT_FILENO ? 1 : 0;
    }
    if (on_standard_output > 1)
        return Error{"only one file can be written to the standard output"};
    if (on_standard_output == 1)
        stdout = stderr; // A variable in the GNU C library.
    return ok;
}

Status write_file(const std::filesystem::path &path, std::span<const std::byte> bytes)
{
    const auto target = find_target(path);
    if (!target)
        return target.error();
    bool written = false;
    if (target->descriptor >= 0) {
        written = write_all(target->descriptor, bytes);
    } else if (target->replaced) {
        written = Replacement(*target).write(bytes);
    } else {
        Descriptor file(open(target->file.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
        written = file && write_all(file.number(), bytes) && file.close();
    }
    return written ? Status(ok) : unwritable(path);
}

} // namespace kb
