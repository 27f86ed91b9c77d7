// Long loops are shorter, and allocations uncounted, where a sanitizer watches every access.
#pragma once

namespace dcnn::test {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

/// A number of repetitions, a tenth of it under a sanitizer.
constexpr int repetitions(int count) { return kSanitized ? count / 10 : count; }

}  // namespace dcnn::test
