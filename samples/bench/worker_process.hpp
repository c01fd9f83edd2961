// SPDX-License-Identifier: MIT
//
// A child process that draws with the Mesa of one prefix. Two Mesas do not fit into one process,
// and a figure of one must not depend on what the other does: so each has its own, and they take
// turns. Parent and child talk in lines of JSON over a socket: one request, one answer.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include <sys/types.h>

namespace kb::bench
{

struct CloseFile {
    void operator()(std::FILE *file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// Next line of JSON, or null at the end of the stream.
nlohmann::json read_message(std::FILE *stream);
void write_message(std::FILE *stream, const nlohmann::json &message);

/// The folder of `prefix` that holds libOSMesa; throws std::runtime_error when there is none.
std::filesystem::path library_folder(const std::filesystem::path &prefix);

/// What a worker was given by the user is no good, as against what it could not do.
class BadInput : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

class WorkerProcess
{
public:
    /// Starts this very program again with --worker in the environment of the prefix, and with one
    /// more variable, NAME=VALUE, unless that is empty.
    WorkerProcess(std::string driver, const std::filesystem::path &prefix,
                  const std::string &setting = "");
    ~WorkerProcess();
    WorkerProcess(const WorkerProcess &) = delete;
    WorkerProcess &operator=(const WorkerProcess &) = delete;

    /// Sends a request and waits for the answer. Throws BadInput or std::runtime_error with the
    /// worker's message when it failed, and std::runtime_error when the worker has ended.
    nlohmann::json ask(const nlohmann::json &request);

    const std::string &driver() const { return driver_; }

private:
    std::string driver_;
    pid_t pid_ = -1;
    File to_;
    File from_;
};

} // namespace kb::bench
