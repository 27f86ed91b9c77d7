// SPDX-License-Identifier: Apache-2.0
// docs/use/effects.md has a row for every effect, in the words of the catalogue.
#include <gtest/gtest.h>

#include "dcnn/core/file.h"
#include "physics/support.h"

namespace dcnn {
namespace {

std::string row_of(const EffectKind& kind) {
  std::string names;
  const Json example = Json::parse(kind.example);
  for (const auto& [name, value] : example.items()) {
    names += (names.empty() ? "`" : ", `") + name + "`";
  }
  return "| `" + std::string(kind.name) + "` | " + kind.kind + " | " + kind.meaning + " | " +
         kind.equation + " | " + (names.empty() ? "none" : names) + " |\n";
}

TEST(EffectsPage, HasARowForEveryEffect) {
  std::string table;
  for (const auto* kind : effect_kinds()) table += row_of(*kind);
  const auto page =
      read_file(std::string(DCNN_SOURCE_DIR "/docs/use/effects.md"), 1 << 20, Exit::kData);
  EXPECT_NE(std::string(page.begin(), page.end()).find(table), std::string::npos)
      << "the table of docs/use/effects.md should be\n"
      << table;
}

}  // namespace
}  // namespace dcnn
