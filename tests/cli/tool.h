/// \file The tool in a folder of its own.
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "cli/text.h"

namespace batten::cli_tests {

struct Outcome {
  int status;
  std::string out;
  std::string err;
};

class Tool : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("batten-tool-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Outcome run(const std::string& arguments) const {
    const std::string command =
        "cd '" + folder_.string() + "' && " BATTEN_TOOL " " + arguments + " >stdout.txt 2>stderr.txt";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), text_of(folder_ / "stdout.txt"), text_of(folder_ / "stderr.txt")};
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }

  fs::path folder_;
};

inline const std::string kModels = BATTEN_SOURCE_DIR "/models/";

}  // namespace batten::cli_tests
