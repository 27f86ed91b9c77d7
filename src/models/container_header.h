// SPDX-License-Identifier: Apache-2.0
// The JSON header of a model file, in the one spelling that encode() gives it.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "dcnn/core/parallel.h"

namespace dcnn {

constexpr std::size_t kMaxHeaderBytes = std::size_t{4} << 20;
constexpr std::size_t kMaxTensors = 4096;
constexpr std::size_t kMaxDimensions = 8;
constexpr std::size_t kDigestDigits = 64;
constexpr const char* kDigestKey = "sha256";

/// Where one tensor lies in the data.
struct TensorEntry {
  std::string name, dtype;  ///< dtype: "F32", "F64" or "I64"
  std::vector<Index> shape;
  std::uint64_t begin = 0, end = 0;  ///< bytes from the beginning of the data
};

struct ContainerHeader {
  std::map<std::string, std::string> metadata;
  std::vector<TensorEntry> tensors;
};

/// Bytes of one value of a dtype, 0 for a dtype this project does not store.
std::uint64_t value_bytes(std::string_view dtype);

/// The header as compact JSON, followed by the fewest spaces that make 8 + its length divisible
/// by 8. Throws Error(kFailure) where a text is not UTF-8.
std::string header_text(const ContainerHeader& header);

/// The inverse of header_text(). Rejects with Error(kModel) any other text, and tensors that do not
/// tile `data_bytes` bytes in order or whose shape does not fit their bytes.
ContainerHeader parse_header(std::string_view text, std::uint64_t data_bytes,
                             const std::string& where);

/// A text as a JSON string, so that no name can break the one line of a message.
std::string quoted(const std::string& text);

/// A broken model file: one line with the file, the fault and the remedy.
[[noreturn]] void reject_model(const std::string& where, const std::string& fault);

}  // namespace dcnn
