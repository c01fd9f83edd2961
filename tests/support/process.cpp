// SPDX-License-Identifier: MIT

#include "tests/support/process.hpp"

#include <array>
#include <cstdlib>
#include <stdexcept>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kb::test
{

ProcessResult run(const std::vector<std::string> &arguments,
                  const std::map<std::string, std::string> &environment)
{
    std::array<int, 2> out{};
    std::array<int, 2> err{};
    if (pipe(out.data()) != 0 || pipe(err.data()) != 0)
        throw std::runtime_error("no pipe");
    const pid_t child = fork();
    if (child < 0)
        throw std::runtime_error("no process");
    if (child == 0) {
        dup2(out[1], STDOUT_FILENO);
        dup2(err[1], STDERR_FILENO);
        for (const int fd : {out[0], out[1], err[0], err[1]})
            close(fd);
        for (const auto &[name, value] : environment)
            setenv(name.c_str(), value.c_str(), 1);
        std::vector<char *> argv;
        for (const auto &argument : arguments)
            argv.push_back(const_cast<char *>(argument.c_str()));
        argv.push_back(nullptr);
        execv(argv[0], argv.data());
        _exit(127);
    }
    close(out[1]);
    close(err[1]);

    ProcessResult result;
    std::array<pollfd, 2> pipes{pollfd{out[0], POLLIN, 0}, pollfd{err[0], POLLIN, 0}};
    std::array<std::string *, 2> texts{&result.out, &result.err};
    while (pipes[0].fd >= 0 || pipes[1].fd >= 0) {
        poll(pipes.data(), pipes.size(), -1);
        for (std::size_t i = 0; i < pipes.size(); ++i) {
            if (pipes[i].fd < 0 || pipes[i].revents == 0)
                continue;
            std::array<char, 4096> buffer;
            const ssize_t count = read(pipes[i].fd, buffer.data(), buffer.size());
            if (count > 0) {
                texts[i]->append(buffer.data(), static_cast<std::size_t>(count));
            } else {
                close(pipes[i].fd);
                pipes[i].fd = -1;
            }
        }
    }
    int status = 0;
    waitpid(child, &status, 0);
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

std::map<std::string, std::string> mesa_environment(const std::string &prefix)
{
    return {
        {"LD_LIBRARY_PATH", prefix + "/" KBUFFER_LIBRARY_DIRECTORY},
        {"__GLX_VENDOR_LIBRARY_NAME", "mesa"},
        {"__EGL_VENDOR_LIBRARY_FILENAMES", prefix + "/share/glvnd/egl_vendor.d/50_mesa.json"},
    };
}

std::string patched_prefix()
{
    const char *prefix = std::getenv("KBUFFER_PREFIX");
    return prefix && *prefix ? prefix : KBUFFER_DEFAULT_PREFIX;
}

std::string stock_prefix()
{
    const char *prefix = std::getenv("KBUFFER_STOCK_PREFIX");
    return prefix ? prefix : "";
}

} // namespace kb::test
