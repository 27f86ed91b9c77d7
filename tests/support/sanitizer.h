// SPDX-License-Identifier: Apache-2.0
// Long loops are shorter, and allocations uncounted, where a sanitizer watches every access.
#pragma once

// GCC defines a macro, Clang answers a question.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DCNN_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DCNN_SANITIZED 1
#endif
#endif

namespace dcnn::test {

#ifdef DCNN_SANITIZED
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

/// A number of repetitions, a tenth of it under a sanitizer.
constexpr int repetitions(int count) { return kSanitized ? count / 10 : count; }

}  // namespace dcnn::test
