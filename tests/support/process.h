// SPDX-License-Identifier: Apache-2.0
// Runs a program as a user would and keeps what it printed.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace dcnn::test {

inline std::string slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A folder that is gone when the test is over.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    // mkdtemp() writes the name's last six letters, which must be X.
    const std::string name = "dcnn-test-" + std::string(6, 'X');
    std::string pattern = (std::filesystem::temp_directory_path() / name).string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct Result {
  int exit_code = -1;  ///< 128 + signal for a process that died of one
  std::string out, err;
};

/// What a program is given beside its arguments.
struct Surroundings {
  std::string input = {};  ///< file for standard input; empty: as the test has it
  std::vector<std::string> environment = {};  ///< NAME=value, added
  std::vector<std::string> wrapper = {};      ///< program and arguments that run it, e.g. strace
};

/// Another program than those of this build.
struct Program {
  std::filesystem::path path;
};

/// A program under way: dcnn-<verb> of this build, or another one, with arguments.
class Process {
 public:
  Process(const std::string& verb, std::vector<std::string> arguments,
          const Surroundings& around = {})
      : Process(Program{std::string(DCNN_BIN_DIR) + "/dcnn-" + verb}, std::move(arguments),
                around) {}
  Process(const Program& program, std::vector<std::string> arguments,
          const Surroundings& around = {}) {
    arguments.insert(arguments.begin(), program.path.string());
    arguments.insert(arguments.begin(), around.wrapper.begin(), around.wrapper.end());
    std::vector<char*> argv;
    for (auto& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ == 0) {
      redirect(STDOUT_FILENO, folder_ / "out");
      redirect(STDERR_FILENO, folder_ / "err");
      if (!around.input.empty()) ::dup2(::open(around.input.c_str(), O_RDONLY), STDIN_FILENO);
      for (const auto& variable : around.environment) ::putenv(::strdup(variable.c_str()));
      ::execvp(argv[0], argv.data());
      ::_exit(127);
    }
  }

  void signal(int number) const { ::kill(pid_, number); }

  Result wait() const {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return {code, slurp(folder_ / "out"), slurp(folder_ / "err")};
  }

 private:
  static void redirect(int descriptor, const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(file, descriptor);
    ::close(file);
  }

  TemporaryFolder folder_;
  pid_t pid_ = -1;
};

inline Result run(const std::string& verb, std::vector<std::string> arguments,
                  const Surroundings& around = {}) {
  return Process(verb, std::move(arguments), around).wait();
}

}  // namespace dcnn::test
