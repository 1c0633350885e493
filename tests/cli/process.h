/// \file The tool as a process of its own, for tests that send signals, close pipes and take rights away.
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/text.h"

namespace batten::cli_tests {

/// A run of the tool in `folder`, started by the constructor; stderr goes to a file beside the folder.
class Process {
 public:
  /// prepare runs in the child before the tool does: limits, descriptors, rights.
  Process(
      const fs::path& folder, std::vector<std::string> arguments, const std::function<void()>& prepare = [] {})
      : errors_(folder.string() + ".stderr") {
    arguments.insert(arguments.begin(), BATTEN_TOOL);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    // A test run in the background ignores these, and so would the tool.
    for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) std::signal(signal, SIG_DFL);
    const bool ready = ::chdir(folder.c_str()) == 0 && redirect("/dev/null", STDOUT_FILENO) &&
                       redirect(errors_.c_str(), STDERR_FILENO);
    prepare();
    if (ready) ::execv(BATTEN_TOOL, argv.data());
    ::_exit(127);
  }
  ~Process() {
    if (!status_) {
      ::kill(pid_, SIGKILL);
      wait();
    }
    fs::remove(errors_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const { ::kill(pid_, signal); }
  bool is_running() {
    int status = 0;
    if (!status_ && ::waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
    return !status_;
  }
  /// The exit code; 128 and the signal where one ended it.
  int wait() {
    int status = 0;
    if (!status_ && ::waitpid(pid_, &status, 0) == pid_) status_ = status;
    return WIFEXITED(*status_) ? WEXITSTATUS(*status_) : 128 + WTERMSIG(*status_);
  }
  /// True once the tool has said that it handles the signal.
  bool handles(int signal) const {
    std::ifstream file("/proc/" + std::to_string(pid_) + "/status");
    for (std::string line; std::getline(file, line);) {
      if (line.rfind("SigCgt:", 0) == 0) return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
    }
    return false;
  }
  std::string errors() const { return text_of(errors_); }

 private:
  static bool redirect(const char* path, int descriptor) {
    const int file = ::open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    return file >= 0 && ::dup2(file, descriptor) == descriptor;
  }

  fs::path errors_;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

}  // namespace batten::cli_tests
