// SPDX-License-Identifier: MIT

#include "lib/io/output_file.hpp"
#include "tests/support/temp_directory.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string_view>

namespace
{

using kb::test::TempDirectory;

kb::Status write(const std::filesystem::path &path, std::string_view text)
{
    return kb::write_file(path, std::as_bytes(std::span(text)));
}

std::string read(const std::filesystem::path &path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string read_all(int descriptor)
{
    std::string text;
    std::array<char, 64> buffer;
    for (ssize_t count; (count = ::read(descriptor, buffer.data(), buffer.size())) > 0;)
        text.append(buffer.data(), static_cast<std::size_t>(count));
    return text;
}

struct stat status_of(const std::filesystem::path &path)
{
    struct stat status {
    };
    EXPECT_EQ(lstat(path.c_str(), &status), 0) << path;
    return status;
}

kb::Status prepare(const std::filesystem::path &file, std::string_view ending)
{
    return kb::prepare_outputs(std::array{kb::OutputFile{file, ending}});
}

TEST(OutputFile, ReplacesARegularFileAndKeepsItsPermissions)
{
    const TempDirectory directory;
    const auto file = directory.write("f", "old and longer");
    ASSERT_EQ(chmod(file.c_str(), 0604), 0);
    const ino_t old = status_of(file).st_ino;
    ASSERT_TRUE(write(file, "new"));
    EXPECT_EQ(read(file), "new");
    EXPECT_EQ(status_of(file).st_mode & 07777U, 0604U);
    EXPECT_NE(status_of(file).st_ino, old) << "who has it open sees all of the old one";
    EXPECT_EQ(directory.file_count(), 1U);
}

TEST(OutputFile, NewFilesGetTheUsersPermissions)
{
    const TempDirectory directory;
    const mode_t old = umask(027);
    EXPECT_TRUE(write(directory / "f", "new"));
    umask(old);
    EXPECT_EQ(status_of(directory / "f").st_mode & 07777U, 0640U);
}

// What a full disk does, a limit does, too.
TEST(OutputFile, AnErrorLeavesWhatWasThere)
{
    const TempDirectory directory;
    const auto file = directory.write("f", "old");
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
    const rlimit small{4, limit.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const auto written = write(file, "too long");
    const auto made = write(directory / "g", "too long");
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, handler);
    EXPECT_FALSE(written);
    EXPECT_FALSE(made);
    EXPECT_EQ(read(file), "old");
    EXPECT_EQ(directory.file_count(), 1U);
}

TEST(OutputFile, ADeviceStaysOneAndItsErrorsAreReported)
{
    const auto full = write("/dev/full", "x");
    ASSERT_FALSE(full);
    EXPECT_EQ(full.error().message, "cannot write /dev/full: No space left on device");
    EXPECT_TRUE(write("/dev/null", "x"));
    EXPECT_TRUE(S_ISCHR(status_of("/dev/full").st_mode));
    EXPECT_TRUE(S_ISCHR(status_of("/dev/null").st_mode));
}

TEST(OutputFile, APipeIsWritten)
{
    const TempDirectory directory;
    const auto file = directory / "pipe";
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    const int reader = open(file.c_str(), O_RDWR | O_NONBLOCK);
    EXPECT_TRUE(prepare(file, ".png"));
    EXPECT_TRUE(write(file, "through it"));
    EXPECT_EQ(read_all(reader), "through it");
    close(reader);
    EXPECT_TRUE(S_ISFIFO(status_of(file).st_mode));
}

TEST(OutputFile, LinksAreFollowed)
{
    const TempDirectory directory;
    const TempDirectory elsewhere;
    const auto target = elsewhere.write("target", "old");
    const auto link = directory / "link";
    std::filesystem::create_symlink("second", link);
    std::filesystem::create_symlink(target, directory / "second");
    ASSERT_TRUE(write(link, "new"));
    EXPECT_EQ(read(target), "new");
    std::filesystem::remove(target);
    ASSERT_TRUE(prepare(link, ""));
    ASSERT_TRUE(write(link, "made")) << "a link to what is not there yet";
    EXPECT_EQ(read(target), "made");
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_TRUE(std::filesystem::is_symlink(directory / "second"));
    EXPECT_EQ(directory.file_count(), 2U);

    std::filesystem::create_symlink("loop", directory / "loop");
    const auto loop = write(directory / "loop", "x");
    ASSERT_FALSE(loop);
    EXPECT_NE(loop.error().message.find("symbolic links"), std::string::npos)
        << loop.error().message;
}

TEST(OutputFile, AnOpenFileIsWrittenWhereItStands)
{
    const TempDirectory directory;
    const auto file = directory.write("f", "");
    const int number = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
    ASSERT_EQ(::write(number, "before ", 7), 7);
    const std::string name = "/dev/fd/" + std::to_string(number);
    EXPECT_TRUE(prepare(name, ".png"));
    EXPECT_TRUE(write(name, "data"));
    ASSERT_EQ(::write(number, " after", 6), 6);
    close(number);
    EXPECT_EQ(read(file), "before data after");
    EXPECT_FALSE(prepare(name, "")) << "it is closed";
    EXPECT_FALSE(write(name, "data"));
}

TEST(OutputFile, WhatCannotBeWrittenIsFoundOutBefore)
{
    const TempDirectory directory;
    const auto file = directory.write("file", "");
    for (const auto &path :
         {directory / "no/such/place", directory / ".", directory / "..", file / "in it",
          directory / "", std::filesystem::path("/dev/fd/999")}) {
        EXPECT_FALSE(prepare(path, "")) << path;
        EXPECT_FALSE(write(path, "x")) << path;
    }
    EXPECT_EQ(directory.file_count(), 1U);
    ASSERT_EQ(chmod(file.c_str(), 0400), 0);
    EXPECT_EQ(bool(prepare(file, "")), geteuid() == 0) << "root may write everywhere";
}

TEST(OutputFile, NamesOfOtherFormatsAreRefused)
{
    const TempDirectory directory;
    for (const char *name : {"p.png", "p.PNG", "p", "p.0001", "p.new"})
        EXPECT_TRUE(prepare(directory / name, ".png")) << name;
    for (const char *name : {"p.jpg", "p.JPEG", "p.png.pfm", "p.json"}) {
        const auto refused = prepare(directory / name, ".png");
        ASSERT_FALSE(refused) << name;
        EXPECT_NE(refused.error().message.find("it is a .png file"), std::string::npos);
    }
    EXPECT_FALSE(prepare(directory / "program.png", ""));
    EXPECT_TRUE(prepare(directory / "program.txt", ""));
    EXPECT_TRUE(prepare("", ".png")) << "not wanted";
    EXPECT_EQ(directory.file_count(), 0U);
}

TEST(OutputFile, AFileTakesOne)
{
    const TempDirectory directory;
    const std::string file = directory / "out";
    const std::string link = directory / "link";
    std::filesystem::create_symlink(file, link);
    const auto refused =
        kb::prepare_outputs(std::array{kb::OutputFile{file, ".png"}, kb::OutputFile{link, ".pfm"}});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find(link), std::string::npos);
    EXPECT_TRUE(kb::prepare_outputs(
        std::array{kb::OutputFile{file, ".png"}, kb::OutputFile{directory / "other", ".pfm"}}));
}

TEST(OutputFile, TheStandardOutputTakesOne)
{
    const auto refused =
        kb::prepare_outputs(std::array{kb::OutputFile{"-", ".png"}, kb::OutputFile{"-", ".pfm"}});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("standard output"), std::string::npos);
}

} // namespace
