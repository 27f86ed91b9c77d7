// SPDX-License-Identifier: Apache-2.0
#include "support/no_allocation.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <cstdlib>
#include <memory>
#include <mutex>
#include <vector>

#include "support/sanitizer.h"

namespace {

// Plain numbers of a thread: reading them allocates nothing.
thread_local bool counting = false;
thread_local long allocation_count = 0, lock_count = 0;

}  // namespace

#if defined(__GLIBC__) && !defined(DCNN_SANITIZED)
#define DCNN_COUNTS_HEAP 1
namespace {
void count_allocation() {
  if (counting) ++allocation_count;
}
}  // namespace

// The program's own definitions come before the C library's, whose other names do the work.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  count_allocation();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  count_allocation();
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  count_allocation();
  return __libc_realloc(old, size);
}
void free(void* memory) {
  count_allocation();
  __libc_free(memory);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count_allocation();
  return __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  count_allocation();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  count_allocation();
  *memory = __libc_memalign(alignment, size);
  return *memory ? 0 : 12;  // ENOMEM
}

using LockFunction = int (*)(pthread_mutex_t*);
int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static LockFunction next = nullptr;
  if (!next) next = reinterpret_cast<LockFunction>(::dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  if (counting) ++lock_count;
  return next(mutex);
}
}
#endif

namespace dcnn::test {

HeapCounter::HeapCounter() {
  allocation_count = lock_count = 0;
  counting = true;
}
HeapCounter::~HeapCounter() { counting = false; }
long HeapCounter::allocations() { return allocation_count; }
long HeapCounter::locks() { return lock_count; }
bool HeapCounter::works() {
#ifdef DCNN_COUNTS_HEAP
  return true;
#else
  return false;
#endif
}

namespace {

class HeapCounterTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!HeapCounter::works()) GTEST_SKIP() << "the heap has other functions here";
  }
};

/// Not to be optimised away.
void* volatile kept;

template <class Use>
long allocations_of(const Use& use) {
  const HeapCounter counter;
  use();
  return HeapCounter::allocations();
}

TEST_F(HeapCounterTest, SeesEveryWayToAllocate) {
  EXPECT_EQ(allocations_of([] {}), 0);
  EXPECT_EQ(allocations_of([] { kept = std::malloc(10); }), 1);
  EXPECT_EQ(allocations_of([] { kept = std::realloc(kept, 20); }), 1);
  EXPECT_EQ(allocations_of([] { std::free(kept); }), 1);
  EXPECT_EQ(allocations_of([] { kept = std::calloc(2, 8); }), 1);
  std::free(kept);
  EXPECT_EQ(allocations_of([] { kept = std::aligned_alloc(64, 64); }), 1);
  std::free(kept);
  EXPECT_EQ(allocations_of([] { kept = new int(1); }), 1);
  EXPECT_EQ(allocations_of([] { delete static_cast<int*>(kept); }), 1);
  EXPECT_EQ(allocations_of([] { kept = new std::vector<double>(100); }), 2);
  EXPECT_EQ(allocations_of([] { delete static_cast<std::vector<double>*>(kept); }), 2);
}

TEST_F(HeapCounterTest, SeesLocks) {
  std::mutex mutex;
  const HeapCounter counter;
  mutex.lock();
  mutex.unlock();
  EXPECT_EQ(HeapCounter::locks(), 1);
}

TEST_F(HeapCounterTest, EndsWithItsScope) {
  { const HeapCounter counter; }
  kept = std::malloc(10);
  std::free(kept);
  EXPECT_EQ(HeapCounter::allocations(), 0);
}

}  // namespace
}  // namespace dcnn::test
