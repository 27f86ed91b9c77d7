// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/parallel.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "dcnn/core/interruptible.h"

// ThreadSanitizer does not see the locks of an OpenMP runtime: under it the pieces run on threads
// whose beginning and end it knows.
#ifdef __has_feature
#if __has_feature(thread_sanitizer)
#define DCNN_PLAIN_THREADS
#endif
#endif
#ifdef __SANITIZE_THREAD__
#define DCNN_PLAIN_THREADS
#endif

namespace dcnn {

Index piece_count(Index n) {
  constexpr Index kLargest = 13, kMultiple = 4;
  if (n < kMultiple) return std::min<Index>(n, 1);
  return kMultiple * ((n + kLargest * kMultiple - 1) / (kLargest * kMultiple));
}

namespace {

constexpr int kMostThreads = 1024;
std::atomic<int> most_threads{kMostThreads};  // that can be made, as far as is known
std::atomic<int> made_threads{1};             // at once, so far

int wanted_threads() { return std::min(omp_get_max_threads(), most_threads.load()); }

/// Whether `bytes` can be had at this moment; a compiler may not leave the question out.
bool has_room(std::size_t bytes) {
  void* volatile block = std::malloc(bytes);
  const bool had = block != nullptr;
  std::free(block);
  return had;
}

/// Whether as many threads, this one among them, can be there at once and have a heap each: the
/// C library gives a thread its own at its first allocation (up to 128 MiB of addresses), and one
/// that it gave keeps it for later threads. What is left must hold one more, so that none was
/// refused.
bool can_be_made(int wanted) {
  constexpr std::size_t kHeap = std::size_t{256} << 20;
  std::vector<std::thread> others;
  std::atomic<int> ready{0};
  std::atomic<bool> go{false};
  try {
    others.reserve(static_cast<std::size_t>(wanted));
    while (static_cast<int>(others.size()) + 1 < wanted) {
      others.emplace_back([&] {
        has_room(1);
        ++ready;
        ready.notify_one();
        go.wait(false);
      });
    }
  } catch (const std::exception&) {  // a limit of threads or of memory
  }
  const int made = static_cast<int>(others.size());
  for (int now = ready; now < made; now = ready) ready.wait(now);
  const bool enough = made + 1 == wanted && has_room(kHeap);
  go = true;
  go.notify_all();
  for (std::thread& other : others) other.join();
  return enough;
}

/// A runtime that cannot make a thread ends the program: where threads or memory run short, this
/// one does all the work. The pieces are the same for any number of threads.
int possible_threads() {
  const int wanted = wanted_threads();
  if (wanted <= made_threads) return wanted;
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  if (wanted <= made_threads) return wanted;
  if (can_be_made(wanted)) {
    made_threads = wanted;
  } else {
    most_threads = made_threads.load();
  }
  return made_threads;
}

#ifdef DCNN_PLAIN_THREADS
/// As OpenMP below: contiguous pieces for each thread, and no threads within threads.
void on_threads(Index count, const std::function<void(Index)>& work) {
  thread_local bool inside = false;
  const Index most = inside || count < 2 ? 1 : possible_threads();
  const Index threads = std::max<Index>(1, std::min(count, most));
  const auto share = [&](Index t) {
    const bool before = std::exchange(inside, true);
    for (Index k = count * t / threads; k < count * (t + 1) / threads; ++k) work(k);
    inside = before;
  };
  std::vector<std::thread> others;
  for (Index t = 1; t < threads; ++t) others.emplace_back(share, t);
  share(0);
  for (std::thread& other : others) other.join();
}
#else
void on_threads(Index count, const std::function<void(Index)>& work) {
  const int threads = count > 1 && omp_in_parallel() == 0 ? possible_threads() : 1;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
  for (Index k = 0; k < count; ++k) work(k);
}
#endif

std::atomic<const std::function<bool()>*> wish_to_stop{nullptr};

}  // namespace

Interruptible::Interruptible(std::function<bool()> wish) : wish_(std::move(wish)) {
  if (wish_) wish_to_stop = &wish_;
}

Interruptible::~Interruptible() { wish_to_stop = nullptr; }

void for_each_piece(Index count, const std::function<void(Index)>& work) {
  const std::function<bool()>* wish = wish_to_stop;
  if (wish != nullptr && (*wish)()) throw Interrupted();
  // What leaves a parallel region as an exception ends the program.
  std::exception_ptr thrown;
  Index thrown_by = count;
  std::mutex mutex;
  on_threads(count, [&](Index k) {
    try {
      work(k);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (k < thrown_by) {
        thrown = std::current_exception();
        thrown_by = k;
      }
    }
  });
  if (thrown) std::rethrow_exception(thrown);
}

void set_threads(int threads) {
  if (threads > 0) omp_set_num_threads(threads);
}

int threads() { return wanted_threads(); }

}  // namespace dcnn
