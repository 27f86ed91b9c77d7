// SPDX-License-Identifier: Apache-2.0
#include "cells/cell_process.h"

#include <fcntl.h>
#include <fnmatch.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "dcnn/core/file.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostResultBytes = std::size_t{1} << 31;
constexpr std::size_t kLogBytes = 4000;
constexpr std::chrono::seconds kPatience{5};      // between SIGTERM and SIGKILL
constexpr int kOutOfTime = 124, kNotThere = 127;  // as timeout(1) and shells have them

std::vector<char*> pointers(const std::vector<std::string>& words) {
  std::vector<char*> all;
  for (const std::string& word : words) all.push_back(const_cast<char*>(word.c_str()));
  all.push_back(nullptr);
  return all;
}

/// The program that a shell would run: from the folders of the path, or by its path in the cell.
std::string program_of(const std::string& name, const std::vector<std::string>& path) {
  if (name.find('/') != std::string::npos) return name;
  for (const std::string& folder : path) {
    const std::string file = folder + "/" + name;
    if (::access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file)) return file;
  }
  return "";
}

/// Between fork and exec: system calls alone.
[[noreturn]] void become(const char* program, char* const* words, char* const* environment,
                         const char* folder, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  if (::getppid() != parent || ::chdir(folder) != 0) ::_exit(kNotThere);
  constexpr int kAppend = O_WRONLY | O_CREAT | O_APPEND;
  const int in = ::open("/dev/null", O_RDONLY), out = ::open("stdout", kAppend, 0644),
            err = ::open("stderr", kAppend, 0644);
  if (in < 0 || out < 0 || err < 0 || ::dup2(in, 0) < 0 || ::dup2(out, 1) < 0 ||
      ::dup2(err, 2) < 0) {
    ::_exit(kNotThere);
  }
  ::execve(program, words, environment);
  constexpr char kWords[] = "cannot run this program\n";
  if (::write(2, kWords, sizeof kWords - 1) < 0) {
  }
  ::_exit(kNotThere);
}

bool matches(const std::string& name, const std::vector<std::string>& patterns) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
  });
}

}  // namespace

CellSurroundings::CellSurroundings(const fs::path& root_folder, const fs::path& programs,
                                   int threads)
    : root(root_folder) {
  const char* outer = std::getenv("PATH");
  const std::string all = programs.string() + ":" + (outer ? outer : "/usr/bin:/bin");
  std::istringstream folders(all);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!folder.empty()) path.push_back(folder);
  }
  environment = {"PATH=" + all, "OMP_NUM_THREADS=" + std::to_string(threads), "LC_ALL=C"};
  for (const char* name : {"LD_LIBRARY_PATH", "HOME", "TMPDIR"}) {
    if (const char* value = std::getenv(name))
      environment.push_back(std::string(name) + "=" + value);
  }
}

CellProcess::CellProcess(const Cell& cell, const CellSurroundings& surroundings, fs::path folder)
    : cell_(cell), surroundings_(surroundings), folder_(std::move(folder)) {
  result_.key = cell.key;
  std::error_code error;
  fs::create_directories(folder_ / "out", error);
  if (!error) fs::create_directory_symlink(surroundings.root, folder_ / "in", error);
  require(!error, Exit::kFailure, folder_.string(), ": cannot make this folder: ", error.message(),
          "; name another --scratch");
  for (const auto& [name, document] : cell.files.items()) {
    write_file(folder_ / name, document.dump(2) + "\n");
  }
  start_command();
}

CellProcess::~CellProcess() {
  if (process_ > 0) {
    ::kill(-process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void CellProcess::start_command() {
  const auto& words = cell_.commands[command_];
  const std::string program = program_of(words.front(), surroundings_.path),
                    folder = folder_.string();
  const auto arguments = pointers(words), environment = pointers(surroundings_.environment);
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0)
    become(program.c_str(), arguments.data(), environment.data(), folder.c_str(), parent);
  if (process_ < 0) fail(Exit::kFailure, "cannot start a process: ", std::strerror(errno));
  ::setpgid(process_, process_);  // here too: it may be signalled before it gets there itself
}

bool CellProcess::finished() {
  while (process_ > 0) {
    int status = 0;
    struct rusage usage {};
    const pid_t ended = ::wait4(process_, &status, WNOHANG, &usage);
    if (ended < 0 && errno == EINTR) continue;
    if (ended == 0) {
      watch_time();
      return false;
    }
    result_.cpu_seconds += static_cast<double>(usage.ru_utime.tv_sec) +
                           1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
    result_.memory_kb = std::max<std::int64_t>(result_.memory_kb, usage.ru_maxrss);
    command_ended(status);
  }
  return true;
}

void CellProcess::command_ended(int status) {
  ::kill(-process_, SIGKILL);  // what it left running
  process_ = -1;
  result_.exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (out_of_time_) result_.exit = kOutOfTime;
  if (result_.exit == 0 && !asked_to_end_ && ++command_ < cell_.commands.size())
    return start_command();
  result_.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
}

void CellProcess::watch_time() {
  if (cell_.timeout_s <= 0.0) return;
  const auto now = Clock::now();
  if (!out_of_time_ && now - start_ > std::chrono::duration<double>(cell_.timeout_s)) {
    out_of_time_ = true;
    asked_ = now;
    ask_to_end();
  } else if (out_of_time_ && now - asked_ > kPatience) {
    ::kill(-process_, SIGKILL);
  }
}

void CellProcess::ask_to_end() {
  asked_to_end_ = true;
  if (process_ > 0) ::kill(-process_, SIGTERM);
}

bool CellProcess::ended_from_outside() const {
  if (out_of_time_) return false;
  constexpr int kSignals[] = {SIGTERM, SIGINT, SIGHUP, SIGUSR1};
  return exit() == static_cast<int>(Exit::kInterrupted) ||
         std::any_of(std::begin(kSignals), std::end(kSignals),
                     [&](int signal) { return exit() == 128 + signal; });
}

/// Its end, as text that JSON can hold.
std::string CellProcess::standard_error() const {
  std::string text = read_file(folder_ / "stderr", kMostResultBytes, Exit::kFailure);
  if (out_of_time_) text += "ended after " + std::to_string(cell_.timeout_s) + " s\n";
  if (text.size() > kLogBytes) text.erase(0, text.size() - kLogBytes);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) >= 0x80 ||
        (static_cast<unsigned char>(c) < 0x20 && c != '\n'))
      c = '?';
  }
  return text;
}

CellResult CellProcess::result() const {
  CellResult result = result_;
  result.log = standard_error();
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out")) {
    const std::string name = fs::relative(entry.path(), folder_ / "out").string();
    if (!entry.is_regular_file() || entry.is_symlink()) continue;
    if (!matches(name, cell_.keep) || matches(name, cell_.drop)) continue;
    result.files.emplace_back(name, read_file(entry.path(), kMostResultBytes, Exit::kFailure));
  }
  std::string printed = read_file(folder_ / "stdout", kMostResultBytes, Exit::kFailure);
  if (!printed.empty() && !matches("stdout", cell_.drop))
    result.files.emplace_back("stdout", std::move(printed));
  std::sort(result.files.begin(), result.files.end());
  return result;
}

}  // namespace dcnn
