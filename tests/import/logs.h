// SPDX-License-Identifier: Apache-2.0
// Logs as others write them, and what becomes of them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "dcnn/core/error.h"
#include "dcnn/import/assemble.h"
#include "support/process.h"

namespace dcnn::test {

inline void spill(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// What dcnn-import does without options but `wishes`: guesses are questions.
inline Imported import_log(const std::vector<std::filesystem::path>& paths,
                           const ImportWishes& wishes = {}, const ReadLogOptions& read = {}) {
  const ForeignLog log = read_log(paths, read);
  Proposal proposal = propose(log, wishes);
  std::string open;
  for (const auto& ask : proposal.questions) open += ask + "\n";
  for (const auto& ask : proposal.guesses) open += ask + "\n";
  if (!open.empty()) throw Error(Exit::kData, open);
  proposal.recipe.files = static_cast<int>(paths.size());
  proposal.recipe.text = read.text;
  const Recipe again = parse_recipe(to_json(proposal.recipe), "import.json");
  EXPECT_EQ(to_json(again), to_json(proposal.recipe));
  std::string whole;
  for (const auto& path : paths) whole += (whole.empty() ? "" : "+") + path.string();
  return import_recording(whole, again, read);  // as --recipe does
}

inline Imported import_text(const std::string& text, const ImportWishes& wishes = {},
                            const ReadLogOptions& read = {}) {
  const TemporaryFolder folder;
  spill(folder / "log.txt", text);
  return import_log({folder / "log.txt"}, wishes, read);
}

inline double cell(const Imported& imported, const std::string& column, Index row) {
  const auto& columns = imported.table.columns;
  const auto found = std::find(columns.begin(), columns.end(), column);
  EXPECT_NE(found, columns.end()) << "no column " << column;
  return found == columns.end() ? std::nan("")
                                : imported.table.values(row, found - columns.begin());
}

/// The three rows that each dialect of a log writes in its own way.
inline void expect_three_rows(const Imported& imported) {
  ASSERT_EQ(imported.table.values.rows(), 3);
  for (Index row = 0; row < 3; ++row) {
    const auto k = static_cast<double>(row);
    EXPECT_NEAR(cell(imported, "t", row) - cell(imported, "t", 0), 0.01 * k, 1e-6);
    EXPECT_EQ(cell(imported, "fx", row), 1.5 + k);
    EXPECT_EQ(cell(imported, "fy", row), -0.25);
    EXPECT_EQ(cell(imported, "fz", row), 1000.0);
  }
}

inline bool has_column(const Imported& imported, const std::string& column) {
  const auto& columns = imported.table.columns;
  return std::find(columns.begin(), columns.end(), column) != columns.end();
}

/// The message of the Error(kData) that `action` throws.
template <class Action>
std::string data_error(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kData) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

}  // namespace dcnn::test
