// SPDX-License-Identifier: Apache-2.0
// What a piece of code asked of the heap and of locks: real-time code must ask nothing.
#pragma once

namespace dcnn::test {

/// While alive, counts this thread's calls of malloc, calloc, realloc, free, the aligned
/// allocations (operator new and delete come down to these) and pthread_mutex_lock. Guards do not
/// nest.
class HeapCounter {
 public:
  HeapCounter();
  ~HeapCounter();
  HeapCounter(const HeapCounter&) = delete;
  HeapCounter& operator=(const HeapCounter&) = delete;

  static long allocations();  ///< and frees, since the newest counter began
  static long locks();
  /// Whether calls are seen at all: not under a sanitizer, which has functions of its own.
  static bool works();
};

}  // namespace dcnn::test
