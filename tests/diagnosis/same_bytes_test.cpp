// SPDX-License-Identifier: Apache-2.0
// A report does not depend on the processor: neither on its caches nor on the instructions that the
// C library chooses for it.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <filesystem>
#include <set>
#include <sstream>

#include "diagnosis/support.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

/// Friction, hum, and recordings long enough that Eigen would cut products over their samples by
/// the caches.
Json small_case() {
  Json config = test::configuration(
      {test::hidden("coulomb_friction", "tool_z", {{"fc_n", 0.3}, {"v0_mps", 0.01}}),
       test::hidden("hum", nullptr,
                    {{"freq_hz", 7.0},
                     {"sin_x_n", 0.05},
                     {"sin_y_n", 0.0},
                     {"sin_z_n", 0.03},
                     {"cos_x_n", 0.0},
                     {"cos_y_n", 0.04},
                     {"cos_z_n", 0.0}})});
  for (Json& recording : config["recordings"]) recording["samples"] = 3000;
  return config;
}

TEST(SameBytes, WhateverCachesTheProcessorHas) {
  constexpr std::ptrdiff_t kKilo = 1024;
  const test::Bench bench(small_case());
  std::set<std::string> reports;
  for (const auto& [first, second, third] :
       {std::array{16 * kKilo, 64 * kKilo, 512 * kKilo},
        std::array{48 * kKilo, 2048 * kKilo, 36 * 1024 * kKilo},
        std::array{256 * kKilo, 8192 * kKilo, 256 * 1024 * kKilo}}) {
    Eigen::setCpuCacheSizes(first, second, third);
    reports.insert(bench.diagnose().report.dump());
  }
  EXPECT_EQ(reports.size(), 1U);
}

/// report.json of the program with the C library's choice of instructions narrowed.
std::string report_with(const test::Bench& bench, const std::string& tunables) {
  const test::TemporaryFolder out;
  const auto result = test::run(
      "diagnose",
      {"--quiet", "--sim", (bench / "sim.json").string(), "--fit", (bench / "fit.csv").string(),
       "--holdout", (bench / "hold.csv").string(), "--out", out.path().string()},
      {.environment = {"GLIBC_TUNABLES=" + tunables}});
  EXPECT_LT(result.exit_code, 2) << result.err;
  return test::slurp(out / "report.json");
}

TEST(SameBytes, WhateverInstructionsTheCLibraryChooses) {
  const test::Bench bench(small_case());
  const std::string report = report_with(bench, "");
  EXPECT_NE(report.find("coulomb_friction"), std::string::npos);
  // The second form of the names is that of glibc before 2.33.
  EXPECT_EQ(report, report_with(bench,
                                "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX2_Usable,-FMA_Usable,"
                                "-FMA4_Usable"));
}

/// The names that an object file leaves to other libraries.
std::set<std::string> foreign_names(const fs::path& object) {
  const test::TemporaryFolder folder;
  const fs::path list = folder / "names";
  const std::string command = "nm -u '" + object.string() + "' > '" + list.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::set<std::string> names;
  std::istringstream text(test::slurp(list));
  for (std::string mark, name; text >> mark >> name;) names.insert(name);
  return names;
}

TEST(SameBytes, NoFunctionWhoseLastBitsTheCLibraryChooses) {
  // What glibc has several variants of, or had in one version; floor, rint and the like are exact
  // in all.
  const std::set<std::string> chosen{"exp",   "exp2",  "exp10", "expm1", "log",   "log2",   "log10",
                                     "log1p", "pow",   "sin",   "cos",   "tan",   "asin",   "acos",
                                     "atan",  "atan2", "sinh",  "cosh",  "tanh",  "sincos", "cbrt",
                                     "cexp",  "clog",  "cpow",  "fma",   "hypot", "cabs",   "carg"};
  const fs::path root = fs::path(DCNN_BINARY_DIR) / "CMakeFiles/dcnn.dir";
  std::set<std::string> rooms;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".o") continue;
    for (const std::string room : {"data", "physics", "diagnosis"}) {
      const std::string path = entry.path().string();
      if (path.find("/src/" + room + "/") == std::string::npos &&
          path.find("unity_" + room + "_") == std::string::npos) {
        continue;
      }
      rooms.insert(room);
      for (const std::string& name : foreign_names(entry.path())) {
        EXPECT_FALSE(chosen.contains(name)) << path << " uses " << name;
      }
    }
  }
  EXPECT_EQ(rooms.size(), 3U) << "no object files below " << root;
}

}  // namespace
}  // namespace dcnn
