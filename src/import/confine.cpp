// SPDX-License-Identifier: Apache-2.0
#include "import/confine.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "dcnn/core/error.h"

namespace dcnn {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kArchitecture = 0;  // no filter is known: nothing is read
#endif

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DCNN_SHADOW_MEMORY 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DCNN_SHADOW_MEMORY 1
#endif
#endif

constexpr rlim_t kMostMemory = rlim_t{8} << 30, kMostSeconds = 300, kMostDescriptors = 8;
constexpr int kPipe = 3;  // the child's descriptor of what it sends
constexpr std::uint64_t kMostRecord = std::uint64_t{1} << 32;

/// Reading, memory, time and the end: what a library that reads one open file needs.
constexpr long kAllowed[] = {
    SYS_read,           SYS_pread64,       SYS_lseek,        SYS_write,  SYS_close,
    SYS_fstat,          SYS_newfstatat,    SYS_mmap,         SYS_munmap, SYS_mremap,
    SYS_mprotect,       SYS_madvise,       SYS_brk,          SYS_futex,  SYS_rt_sigaction,
    SYS_rt_sigprocmask, SYS_rt_sigreturn,  SYS_sigaltstack,  SYS_exit,   SYS_exit_group,
    SYS_getrandom,      SYS_clock_gettime, SYS_gettimeofday, SYS_getpid, SYS_gettid,
    SYS_tgkill,         SYS_sched_yield,   SYS_flock,        SYS_fcntl,  SYS_getcwd,
    SYS_uname,          SYS_sysinfo,
#ifdef SYS_stat
    SYS_stat,           SYS_lstat,
#endif
#ifdef DCNN_SHADOW_MEMORY
    SYS_pipe2,  // by which a sanitizer learns whether memory can be read
#ifdef SYS_pipe
    SYS_pipe,
#endif
#endif
};

/// openat() for reading alone.
constexpr std::uint32_t kOpenForMore = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;

void push(std::vector<sock_filter>* code, sock_filter line) { code->push_back(line); }

void install_filter(bool may_open) {
  std::vector<sock_filter> code;
  const auto load = [](std::size_t offset) -> sock_filter {
    return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
  };
  const auto answer = [](std::uint32_t value) -> sock_filter {
    return BPF_STMT(BPF_RET | BPF_K, value);
  };
  const auto skip_unless_equal = [](std::uint32_t value, std::uint8_t skip) -> sock_filter {
    return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, skip);
  };
  push(&code, load(offsetof(seccomp_data, arch)));
  push(&code, BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kArchitecture, 1, 0));
  push(&code, answer(SECCOMP_RET_KILL_PROCESS));
  push(&code, load(offsetof(seccomp_data, nr)));
  for (const long call : kAllowed) {
    push(&code, skip_unless_equal(static_cast<std::uint32_t>(call), 1));
    push(&code, answer(SECCOMP_RET_ALLOW));
  }
  if (may_open) {
    push(&code, skip_unless_equal(SYS_openat, 3));
    push(&code, load(offsetof(seccomp_data, args[2])));
    push(&code, BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, kOpenForMore, 1, 0));
    push(&code, answer(SECCOMP_RET_ALLOW));
    // Filters add up: the second one may be installed while this one holds.
    push(&code, load(offsetof(seccomp_data, nr)));
    push(&code, skip_unless_equal(SYS_prctl, 1));
    push(&code, answer(SECCOMP_RET_ALLOW));
  }
  push(&code, answer(SECCOMP_RET_ERRNO | EPERM));
  sock_fprog program{static_cast<unsigned short>(code.size()), code.data()};
  const bool done = kArchitecture != 0 && ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                    ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
  require(done, Exit::kFailure,
          "this system has no seccomp, without which files of MATLAB are not read; export the log "
          "as text");
}

void limit(int resource, rlim_t most) {
  const rlimit value{most, most};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &value);
}

void enter_confinement(int pipe) {
  ::dup2(pipe, kPipe);
  ::syscall(SYS_close_range, kPipe + 1, ~0U, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  std::signal(SIGXFSZ, SIG_IGN);  // what a library says on a stderr that is a file is lost, no more
  limit(RLIMIT_NOFILE, kMostDescriptors);
  limit(RLIMIT_CPU, kMostSeconds);
#ifndef DCNN_SHADOW_MEMORY
  limit(RLIMIT_AS, kMostMemory);  // a sanitizer maps terabytes as its shadow
#endif
  install_filter(true);
}

void write_whole(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(kPipe, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) ::_exit(1);  // the parent has gone
    bytes.remove_prefix(static_cast<std::size_t>(put));
  }
}

/// A kind, the length, the bytes.
void send_record(char kind, std::string_view bytes) {
  const std::uint64_t size = bytes.size();
  std::array<char, 9> head{kind};
  std::memcpy(head.data() + 1, &size, sizeof(size));
  write_whole({head.data(), head.size()});
  write_whole(bytes);
}

[[noreturn]] void run_child(int pipe, const ConfinedWork& work) {
  try {
    enter_confinement(pipe);
    work([] { install_filter(false); }, [](std::string_view bytes) { send_record('d', bytes); });
    send_record('e', "");
  } catch (const Error& error) {
    send_record(static_cast<char>('0' + static_cast<int>(error.exit())), error.what());
  } catch (...) {
    send_record('3', "needs more memory than is given to it");
  }
  ::_exit(0);
}

bool read_whole(int fd, char* out, std::size_t size) {
  while (size > 0) {
    const ssize_t got = ::read(fd, out, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    out += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

/// True when the child said that all is sent; fills `fault` where it said why not.
bool receive_all(int fd, const std::function<void(std::string_view)>& receive, char* kind,
                 std::string* fault) {
  std::string bytes;
  for (;;) {
    std::array<char, 9> head{};
    std::uint64_t size = 0;
    if (!read_whole(fd, head.data(), head.size())) return false;
    std::memcpy(&size, head.data() + 1, sizeof(size));
    if (size > kMostRecord) return false;
    bytes.resize(static_cast<std::size_t>(size));
    if (!read_whole(fd, bytes.data(), bytes.size())) return false;
    *kind = head[0];
    if (*kind == 'e') return true;
    if (*kind != 'd') return (*fault = bytes, true);
    receive(bytes);
  }
}

}  // namespace

void run_confined(const ConfinedWork& work, const std::function<void(std::string_view)>& receive,
                  const std::string& place) {
  std::array<int, 2> ends{};
  require(::pipe2(ends.data(), O_CLOEXEC) == 0, Exit::kFailure,
          "cannot make a pipe: ", std::strerror(errno));
  const pid_t child = ::fork();
  require(child >= 0, Exit::kFailure, "cannot start a process: ", std::strerror(errno));
  if (child == 0) run_child(ends[1], work);
  ::close(ends[1]);
  char kind = 0;
  std::string fault;
  bool whole = false;
  try {
    whole = receive_all(ends[0], receive, &kind, &fault);
  } catch (...) {
    ::close(ends[0]);
    ::waitpid(child, nullptr, 0);
    throw;
  }
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  require(whole, Exit::kData, place, ": the process that reads it ended (",
          WIFSIGNALED(status) ? std::string("signal ") + std::to_string(WTERMSIG(status))
                              : "exit " + std::to_string(WEXITSTATUS(status)),
          "): the file is damaged");
  if (!fault.empty()) fail(static_cast<Exit>(kind - '0'), place, ": ", fault);
}

}  // namespace dcnn
