// SPDX-License-Identifier: Apache-2.0
// How many instructions one prediction takes, counted by valgrind: a slow-down is seen without a
// clock. Valgrind knows no AVX-512, so these are the kernels for AVX2.
#include <gtest/gtest.h>

#include <cstdlib>

#include "support/process.h"
#include "support/sanitizer.h"
#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace dcnn {
namespace {

constexpr double kPredictions = 10;

struct Count {
  const char* network;
  double instructions;  // of one prediction, GCC 12, -O2
};

bool counted_here() {
#if defined(__GNUC__) && !defined(__clang__)
  return __GNUC__ == 12 && __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

// libhwy executes RDTSCP when it is loaded. Valgrind refuses it where the processor does not
// announce it (CPUID 0x80000001, EDX bit 27), as on some virtual machines.
bool announces_rdtscp() {
#if defined(__x86_64__)
  unsigned a = 0, b = 0, c = 0, d = 0;
  return __get_cpuid(0x80000001U, &a, &b, &c, &d) != 0 && (d >> 27 & 1) != 0;
#else
  return true;
#endif
}

class Instructions : public testing::TestWithParam<Count> {};

TEST_P(Instructions, OfOnePredictionAreNotMoreThanTheyWere) {
  if (test::kSanitized) GTEST_SKIP() << "sanitizers add instructions";
  if (!counted_here()) GTEST_SKIP() << "counts are those of GCC 12 and AVX2";
  if (!announces_rdtscp()) GTEST_SKIP() << "valgrind knows no RDTSCP on this processor";
  if (std::system("valgrind --version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "valgrind is not installed (tools/install-deps --tests)";
  }
  const test::TemporaryFolder folder;
  const auto counts = folder / "counts";
  const std::string command =
      "OMP_NUM_THREADS=1 valgrind --tool=callgrind --toggle-collect=predict "
      "--callgrind-out-file=" +
      counts.string() + " " DCNN_PREDICTIONS " " + GetParam().network + " > /dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  const std::string text = test::slurp(counts);
  const auto at = text.find("\ntotals: ");
  ASSERT_NE(at, std::string::npos) << text.substr(0, 500);
  const double found = std::strtod(text.c_str() + at + 9, nullptr) / kPredictions;
  EXPECT_LT(found, 1.04 * GetParam().instructions);
  EXPECT_GT(found, 0.9 * GetParam().instructions) << "faster: set the new count";
}

INSTANTIATE_TEST_SUITE_P(Networks, Instructions,
                         testing::Values(Count{"valid", 29670}, Count{"same", 117160},
                                         Count{"lstm", 709400}),
                         [](const auto& count) { return std::string(count.param.network); });

}  // namespace
}  // namespace dcnn
