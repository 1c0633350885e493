/// The script ./batten where packages are missing: it asks before it calls sudo, unless -y or CI says not to.
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "cli/text.h"

namespace batten::cli_tests {
namespace {

/// The script alone in a folder, for a user who is not root, on a Debian without any package; sudo only notes its
/// words.
class Script : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("batten-script-" + std::to_string(getpid()));
    fs::create_directories(folder_ / "bin");
    fs::copy_file(fs::path(BATTEN_SOURCE_DIR) / "batten", folder_ / "batten");
    program("id", "echo 1000");
    program("dpkg-query", "exit 1");
    program("apt-get", "exit 1");
    program("sudo", "echo \"$@\" >> '" + (folder_ / "sudo.txt").string() + "'; exit 1");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void program(const std::string& name, const std::string& text) const {
    const fs::path path = folder_ / "bin" / name;
    std::ofstream(path) << "#!/bin/sh\n" << text << "\n";
    fs::permissions(path, fs::perms::owner_all);
  }
  std::string command(const std::string& setting, const std::string& words) const {
    return "cd '" + folder_.string() + "' && unset CI && PATH=" + (folder_ / "bin").string() + ":$PATH " + setting +
           " ./batten " + words;
  }
  /// Runs the script without a terminal; returns what it says.
  std::string said(const std::string& setting, const std::string& words) const {
    const std::string line = "(" + command(setting, words) + ") </dev/null >said.txt 2>&1";
    const int status = std::system(("cd '" + folder_.string() + "' && { " + line + "; }").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1);
    return text_of(folder_ / "said.txt");
  }
  /// Runs the script on a terminal where someone types the answer.
  void answer(const std::string& typed) const {
    int terminal = -1;
    const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child == 0) {
      const std::string line = command("", "info x.obj");
      ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      ::_exit(127);
    }
    EXPECT_EQ(::write(terminal, typed.data(), typed.size()), static_cast<ssize_t>(typed.size()));
    // Reading until the end keeps the child from waiting for room to write.
    char bytes[256];
    while (::read(terminal, bytes, sizeof(bytes)) > 0) {
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 1);
    ::close(terminal);
  }
  bool called_sudo() const { return fs::exists(folder_ / "sudo.txt"); }

  fs::path folder_;
};

TEST_F(Script, DoesNotCallSudoWhereNobodyCanBeAsked) {
  const std::string text = said("", "info x.obj");
  EXPECT_FALSE(called_sudo());
  EXPECT_NE(text.find("cmake"), std::string::npos) << text;
  EXPECT_NE(text.find("-y"), std::string::npos) << text;
}

TEST_F(Script, CallsSudoWithYesOrInContinuousIntegration) {
  said("", "-y info x.obj");
  EXPECT_NE(text_of(folder_ / "sudo.txt").find("apt-get update"), std::string::npos);
  fs::remove(folder_ / "sudo.txt");
  said("CI=true", "info x.obj");
  EXPECT_TRUE(called_sudo());
}

TEST_F(Script, CallsSudoOnlyAfterAYes) {
  answer("n\n");
  EXPECT_FALSE(called_sudo());
  answer("\n");
  EXPECT_FALSE(called_sudo());
  answer("y\n");
  EXPECT_TRUE(called_sudo());
}

}  // namespace
}  // namespace batten::cli_tests
