// SPDX-License-Identifier: Apache-2.0
// What the tests of this room share.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "dcnn/core/error.h"
#include "support/process.h"

namespace dcnn::testing {

using namespace ::testing;  // `testing::` in dcnn still names GoogleTest where this file is
                            // included

/// Writes a file into a folder of this process, which is gone when it ends, and gives its path.
inline std::filesystem::path temporary_file(const std::string& name, const std::string& text) {
  static const test::TemporaryFolder folder;
  std::ofstream(folder / name, std::ios::binary) << text;
  return folder / name;
}

/// The message of the Error that `work` throws, whose code is checked.
template <class Work>
std::string error_of(const Work& work, Exit exit) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), exit) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A file beside the checkout; empty where it is absent.
inline std::filesystem::path shared(const std::string& name) {
  const auto path = std::filesystem::path(DCNN_SOURCE_DIR).parent_path() / "shared" / name;
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

}  // namespace dcnn::testing
