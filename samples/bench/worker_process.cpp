// SPDX-License-Identifier: MIT

#include "bench/worker_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

extern char **environ;

namespace kb::bench
{

namespace
{

struct Pipe {
    File read;
    File write;
};

// Closed on exec: a worker that kept another one's end open would never see it close.
Pipe make_pipe()
{
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
    return {File(fdopen(ends[0], "r")), File(fdopen(ends[1], "w"))};
}

std::vector<std::string> environment_of(const std::filesystem::path &prefix,
                                        const std::string &setting)
{
    std::vector<std::string> environment{
        "LD_LIBRARY_PATH=" + library_folder(prefix).string(),
        "__GLX_VENDOR_LIBRARY_NAME=mesa",
        "__EGL_VENDOR_LIBRARY_FILENAMES=" +
            (prefix / "share/glvnd/egl_vendor.d/50_mesa.json").string(),
        "GALLIUM_DRIVER=llvmpipe",
    };
    if (!setting.empty())
        environment.push_back(setting);
    const std::vector<std::string> ours = environment;
    for (char **variable = environ; *variable != nullptr; ++variable) {
        const std::string text = *variable;
        const std::string name = text.substr(0, text.find('=') + 1);
        bool replaced = false;
        for (const std::string &setting : ours)
            replaced = replaced || setting.starts_with(name);
        if (!replaced)
            environment.push_back(text);
    }
    return environment;
}

std::string how_it_ended(int status)
{
    if (WIFSIGNALED(status))
        return fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    return fmt::format("exit status {}", WEXITSTATUS(status));
}

} // namespace

nlohmann::json read_message(std::FILE *stream)
{
    char *line = nullptr;
    std::size_t capacity = 0;
    const ssize_t length = getline(&line, &capacity, stream);
    const std::unique_ptr<char, decltype(&std::free)> owner(line, &std::free);
    if (length <= 0)
        return nullptr;
    return nlohmann::json::parse(line, line + length);
}

void write_message(std::FILE *stream, const nlohmann::json &message)
{
    const std::string line = message.dump() + "\n";
    std::fwrite(line.data(), 1, line.size(), stream);
    std::fflush(stream);
}

std::filesystem::path library_folder(const std::filesystem::path &prefix)
{
    const std::filesystem::path lib = std::filesystem::absolute(prefix) / "lib";
    std::vector<std::filesystem::path> folders{lib};
    if (std::filesystem::is_directory(lib))
        for (const auto &entry : std::filesystem::directory_iterator(lib))
            if (entry.is_directory())
                folders.push_back(entry.path());
    for (const auto &folder : folders)
        if (std::filesystem::exists(folder / "libOSMesa.so.8"))
            return folder;
    throw std::runtime_error(
        fmt::format("no Mesa in {}: run scripts/build --stock first", prefix.string()));
}

WorkerProcess::WorkerProcess(std::string driver, const std::filesystem::path &prefix,
                             const std::string &setting)
    : driver_(std::move(driver))
{
    // A worker that has died is reported by the answer that does not come.
    std::signal(SIGPIPE, SIG_IGN);

    Pipe requests = make_pipe();
    Pipe answers = make_pipe();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(requests.read.get()), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(answers.write.get()), STDOUT_FILENO);

    std::vector<std::string> environment = environment_of(prefix, setting);
    std::vector<char *> environment_pointers;
    for (std::string &variable : environment)
        environment_pointers.push_back(variable.data());
    environment_pointers.push_back(nullptr);

    std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
    std::string option = "--worker";
    std::array<char *, 3> arguments{program.data(), option.data(), nullptr};
    const int error = posix_spawn(&pid_, program.c_str(), &actions, nullptr, arguments.data(),
                                  environment_pointers.data());
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0)
        throw std::system_error(error, std::generic_category(), "cannot start " + program);
    to_ = std::move(requests.write);
    from_ = std::move(answers.read);
}

WorkerProcess::~WorkerProcess()
{
    to_.reset(); // the end of its requests ends the worker
    if (pid_ > 0)
        waitpid(pid_, nullptr, 0);
}

nlohmann::json WorkerProcess::ask(const nlohmann::json &request)
{
    if (pid_ > 0)
        write_message(to_.get(), request);
    nlohmann::json answer = pid_ > 0 ? read_message(from_.get()) : nlohmann::json{};
    if (answer.is_null()) {
        std::string reason = "it had ended before";
        if (pid_ > 0) {
            int status = 0;
            waitpid(pid_, &status, 0);
            pid_ = -1;
            reason = how_it_ended(status);
        }
        throw std::runtime_error(
            fmt::format("the worker of {} ended during {}: {}", driver_, request.dump(), reason));
    }
    if (answer.contains("bad_input"))
        throw BadInput(answer["bad_input"].get<std::string>());
    if (answer.contains("error"))
        throw std::runtime_error(
            fmt::format("{}: {}", driver_, answer["error"].get<std::string>()));
    return answer;
}

} // namespace kb::bench
