// SPDX-License-Identifier: Apache-2.0
// Preloaded into a program: the FAIL_AT-th call of FAIL_CALL (open, openat, fopen, read, pread,
// write, fsync, rename, renameat2, link, unlink, mkdir, mmap, flock, ftruncate, socket, bind,
// connect, recv, send, ppoll) fails with the number
// FAIL_ERRNO; where that is 0, it does one byte of what it was asked (read, write), and where it is
// below, the process is killed there. The file FAIL_MARK is made when it has. Calls of the C
// library within itself do not come here.
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

template <class Function>
Function next_of(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

enum class Way { kPass, kFail, kShort };

/// What becomes of this call.
Way way_of(const char* call) {
  static const char* const wanted = std::getenv("FAIL_CALL");
  static const long place = wanted ? std::atol(std::getenv("FAIL_AT")) : 0;
  static long count = 0;
  if (!wanted || std::strcmp(call, wanted) != 0 ||
      __atomic_add_fetch(&count, 1, __ATOMIC_RELAXED) != place) {
    return Way::kPass;
  }
  const long mark =
      ::syscall(SYS_openat, AT_FDCWD, std::getenv("FAIL_MARK"), O_CREAT | O_WRONLY, 0600);
  if (mark >= 0) ::syscall(SYS_close, mark);
  const int error = std::atoi(std::getenv("FAIL_ERRNO"));
  if (error < 0) ::kill(::getpid(), SIGKILL);
  errno = error;
  return errno == 0 ? Way::kShort : Way::kFail;
}

template <class Result, class Call>
Result passed(const char* name, Result failed, const Call& call) {
  return way_of(name) == Way::kFail ? failed : call();
}

int opened(const char* name, int folder, const char* path, int flags, mode_t mode) {
  return passed<int>(
      name, -1, [&] { return static_cast<int>(::syscall(SYS_openat, folder, path, flags, mode)); });
}

mode_t mode_of(int flags, va_list list) {
  return (flags & O_CREAT) != 0 ? va_arg(list, mode_t) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  return opened("open", AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  return opened("open", AT_FDCWD, path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  return opened("openat", folder, path, flags, mode);
}
FILE* fopen(const char* path, const char* mode) {
  static const auto next = next_of<FILE* (*)(const char*, const char*)>("fopen");
  return passed<FILE*>("fopen", nullptr, [&] { return next(path, mode); });
}
FILE* fopen64(const char* path, const char* mode) {
  static const auto next = next_of<FILE* (*)(const char*, const char*)>("fopen64");
  return passed<FILE*>("fopen", nullptr, [&] { return next(path, mode); });
}
ssize_t pread(int file, void* buffer, size_t size, off_t at) {
  const Way way = way_of("pread");
  return way == Way::kFail
             ? -1
             : ::syscall(SYS_pread64, file, buffer, way == Way::kShort && size > 1 ? 1 : size, at);
}
ssize_t pread64(int file, void* buffer, size_t size, off64_t at) {
  return pread(file, buffer, size, at);
}
ssize_t read(int file, void* buffer, size_t size) {
  const Way way = way_of("read");
  return way == Way::kFail
             ? -1
             : ::syscall(SYS_read, file, buffer, way == Way::kShort && size > 1 ? 1 : size);
}
ssize_t write(int file, const void* buffer, size_t size) {
  const Way way = way_of("write");
  return way == Way::kFail
             ? -1
             : ::syscall(SYS_write, file, buffer, way == Way::kShort && size > 1 ? 1 : size);
}
int fsync(int file) {
  return passed<int>("fsync", -1, [&] { return static_cast<int>(::syscall(SYS_fsync, file)); });
}
int flock(int file, int operation) {
  return passed<int>("flock", -1,
                     [&] { return static_cast<int>(::syscall(SYS_flock, file, operation)); });
}
int ftruncate(int file, off_t size) noexcept {
  return passed<int>("ftruncate", -1,
                     [&] { return static_cast<int>(::syscall(SYS_ftruncate, file, size)); });
}
int rename(const char* from, const char* to) noexcept {
  return passed<int>("rename", -1, [&] {
    return static_cast<int>(::syscall(SYS_renameat, AT_FDCWD, from, AT_FDCWD, to));
  });
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned flags) noexcept {
  return passed<int>("renameat2", -1, [&] {
    return static_cast<int>(::syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
  });
}
int link(const char* from, const char* to) noexcept {
  return passed<int>("link", -1, [&] {
    return static_cast<int>(::syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0));
  });
}
int unlink(const char* path) noexcept {
  return passed<int>("unlink", -1,
                     [&] { return static_cast<int>(::syscall(SYS_unlinkat, AT_FDCWD, path, 0)); });
}
int mkdir(const char* path, mode_t mode) noexcept {
  return passed<int>(
      "mkdir", -1, [&] { return static_cast<int>(::syscall(SYS_mkdirat, AT_FDCWD, path, mode)); });
}
void* mmap(void* address, size_t size, int protection, int flags, int file, off_t place) noexcept {
  static const auto next = next_of<void* (*)(void*, size_t, int, int, int, off_t)>("mmap");
  return passed<void*>("mmap", MAP_FAILED,
                       [&] { return next(address, size, protection, flags, file, place); });
}
int socket(int domain, int type, int protocol) noexcept {
  static const auto next = next_of<int (*)(int, int, int)>("socket");
  return passed<int>("socket", -1, [&] { return next(domain, type, protocol); });
}
int bind(int file, const sockaddr* name, socklen_t size) noexcept {
  static const auto next = next_of<int (*)(int, const sockaddr*, socklen_t)>("bind");
  return passed<int>("bind", -1, [&] { return next(file, name, size); });
}
int connect(int file, const sockaddr* name, socklen_t size) {
  static const auto next = next_of<int (*)(int, const sockaddr*, socklen_t)>("connect");
  return passed<int>("connect", -1, [&] { return next(file, name, size); });
}
ssize_t recv(int file, void* buffer, size_t size, int flags) {
  static const auto next = next_of<ssize_t (*)(int, void*, size_t, int)>("recv");
  return passed<ssize_t>("recv", -1, [&] { return next(file, buffer, size, flags); });
}
ssize_t send(int file, const void* buffer, size_t size, int flags) {
  static const auto next = next_of<ssize_t (*)(int, const void*, size_t, int)>("send");
  return passed<ssize_t>("send", -1, [&] { return next(file, buffer, size, flags); });
}
int ppoll(pollfd* files, nfds_t count, const timespec* wait, const sigset_t* mask) {
  static const auto next =
      next_of<int (*)(pollfd*, nfds_t, const timespec*, const sigset_t*)>("ppoll");
  return passed<int>("ppoll", -1, [&] { return next(files, count, wait, mask); });
}

}  // extern "C"
