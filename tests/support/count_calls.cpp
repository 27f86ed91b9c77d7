// SPDX-License-Identifier: Apache-2.0
// Preloaded into a program: counts what a real-time loop must not do, between its COUNT_FROM-th
// read (read or recv that brought data) and its COUNT_TO-th one or the end of its input, and writes
// "reads allocations locks" to the file COUNT_FILE.
#include <dlfcn.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace {

long reads = 0, allocations = 0, locks = 0;
bool counting = false, done = false;

template <class Function>
Function next_of(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

void report() {
  counting = false;
  done = true;
  FILE* file = std::fopen(std::getenv("COUNT_FILE"), "w");
  if (!file) return;
  std::fprintf(file, "%ld %ld %ld\n", reads, allocations, locks);
  std::fclose(file);
}

void saw(ssize_t size) {
  const char *from = std::getenv("COUNT_FROM"), *to = std::getenv("COUNT_TO");
  if (done || !from || !to) return;
  if (size > 0) ++reads;
  if (reads >= std::atol(from)) counting = true;
  if (counting && (size == 0 || reads >= std::atol(to))) report();
}

}  // namespace

extern "C" {

void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void __libc_free(void*);

void* malloc(size_t size) {
  allocations += counting;
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  allocations += counting;
  return __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) {
  allocations += counting;
  return __libc_realloc(old, size);
}
void free(void* old) {
  allocations += counting && old != nullptr;
  __libc_free(old);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static const auto next = next_of<int (*)(pthread_mutex_t*)>("pthread_mutex_lock");
  locks += counting;
  return next(mutex);
}

ssize_t read(int file, void* buffer, size_t size) {
  static const auto next = next_of<ssize_t (*)(int, void*, size_t)>("read");
  const ssize_t got = next(file, buffer, size);
  if (file == STDIN_FILENO) saw(got);
  return got;
}

ssize_t recv(int file, void* buffer, size_t size, int flags) {
  static const auto next = next_of<ssize_t (*)(int, void*, size_t, int)>("recv");
  const ssize_t got = next(file, buffer, size, flags);
  if (got > 0) saw(got);
  return got;
}

}  // extern "C"
