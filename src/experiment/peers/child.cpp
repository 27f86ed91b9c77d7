// SPDX-License-Identifier: Apache-2.0
#include "experiment/peers/child.h"

#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>

extern char** environ;

namespace dcnn {

Child::Child(const std::filesystem::path& program, const std::filesystem::path& folder)
    : name_(program.filename().string()) {
  int ends[2];
  require(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0, Exit::kFailure, name_,
          ": cannot make a socket");
  socket_ = ends[0];
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  std::string path = std::filesystem::absolute(program).string();
  char* arguments[] = {path.data(), nullptr};
  const int refused = ::posix_spawn(&pid_, path.c_str(), &actions, nullptr, arguments, environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (refused != 0) pid_ = -1;  // the first hear() says so
}

Child::~Child() {
  ::close(socket_);
  if (pid_ < 0) return;
  ::kill(pid_, SIGTERM);  // it may be in the middle of an epoch
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

Json Child::hear() {
  for (;;) {
    if (const auto end = heard_.find('\n'); end != std::string::npos) {
      const std::string line = heard_.substr(0, end);
      heard_.erase(0, end + 1);
      return parse_json(line, name_, Exit::kFailure);
    }
    std::array<char, 65536> bytes;
    const auto got = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    require(got > 0, Exit::kFailure, name_, ": ended before it answered");
    heard_.append(bytes.data(), static_cast<std::size_t>(got));
  }
}

Json Child::ask(const std::string& line) {
  const std::string text = line + "\n";
  const auto sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  require(sent == static_cast<ssize_t>(text.size()), Exit::kFailure, name_,
          ": ended before it was asked");
  Json answer = hear();
  if (answer.contains("error"))
    fail(Exit::kFailure, name_, ": ", answer["error"].get<std::string>());
  return answer;
}

}  // namespace dcnn
