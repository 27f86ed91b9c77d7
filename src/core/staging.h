// SPDX-License-Identifier: Apache-2.0
// What write_file() and read_file() do while a set of files lives (file_set.h).
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace dcnn {

/// Puts the bytes of a file aside; false where no set lives.
bool put_aside(const std::filesystem::path& file, std::string_view bytes);
/// Where the bytes of a file are that a set has put aside.
std::optional<std::filesystem::path> put_aside_as(const std::filesystem::path& path);

}  // namespace dcnn
