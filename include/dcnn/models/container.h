// SPDX-License-Identifier: Apache-2.0
// The model file: safetensors with a checksum.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "dcnn/core/error.h"
#include "dcnn/core/parallel.h"

namespace dcnn {

/// One tensor of a file: F32, F64 or I64, row-major.
struct StoredTensor {
  std::string name;
  std::vector<Index> shape;
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::int64_t>> values;
};

/// What a file holds: text by key, and tensors in the order of their data.
struct Container {
  std::map<std::string, std::string> metadata;
  std::vector<StoredTensor> tensors;

  const StoredTensor* find(const std::string& name) const;
};

/// The bytes of a safetensors file: 8-byte little-endian header length, JSON header padded with the
/// fewest spaces to 8 bytes, data. `metadata` gains "sha256" over the whole file with its 64 digits
/// set to '0'.
std::string encode(const Container& container);

/// Any byte string is either decoded correctly or rejected with Error(kModel) naming `where`,
/// before anything is allocated from its numbers: lengths, depth, key count, duplicate keys, dtype,
/// shapes (checked products), exact tiling of the buffer, finite values, checksum, canonical
/// padding.
Container decode(std::string_view bytes, const std::string& where);

void write_container(const std::filesystem::path& path, const Container& container);  // atomic
Container read_container(const std::filesystem::path& path);  ///< at most 1 GB

}  // namespace dcnn
