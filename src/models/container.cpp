// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/container.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"
#include "models/container_header.h"

namespace dcnn {
namespace {

constexpr std::size_t kLengthBytes = 8;
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;

template <class T>
using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

template <class T>
void append_little(std::string& bytes, T value) {
  const auto bits = std::bit_cast<Bits<T>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes += static_cast<char>(bits >> (8 * i));
}

template <class T>
T load_little(const char* bytes) {
  Bits<T> bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bits |= static_cast<Bits<T>>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  return std::bit_cast<T>(bits);
}

template <class T>
bool all_finite(const std::vector<T>& values) {
  if constexpr (std::is_floating_point_v<T>) {
    for (const T value : values) {
      if (!std::isfinite(value)) return false;
    }
  }
  return true;
}

const char* dtype_of(const std::vector<float>&) { return "F32"; }
const char* dtype_of(const std::vector<double>&) { return "F64"; }
const char* dtype_of(const std::vector<std::int64_t>&) { return "I64"; }

/// SHA-256 in lower-case hex of the bytes with the 64 digits at `digits` read as '0'.
std::string digest(std::string_view bytes, std::size_t digits) {
  return sha256_hex({bytes.substr(0, digits), std::string(kDigestDigits, '0'),
                     bytes.substr(digits + kDigestDigits)});
}

/// Where the digits of the checksum begin in a header; the key is a plain word, so it is found
/// verbatim. Escaped quotes inside values cannot imitate it: there every quote has a backslash
/// before it.
std::size_t digits_place(std::string_view header) {
  const std::string key = '"' + std::string(kDigestKey) + "\":\"";
  return header.find(key) + key.size();
}

/// The tensor's place after `begin`, checked against what decode() will accept.
TensorEntry describe(const StoredTensor& tensor, std::uint64_t begin) {
  TensorEntry entry{
      .name = tensor.name, .dtype = {}, .shape = tensor.shape, .begin = begin, .end = 0};
  assert(tensor.shape.size() <= kMaxDimensions);
  std::visit(
      [&](const auto& values) {
        assert(static_cast<Index>(values.size()) == std::accumulate(tensor.shape.begin(),
                                                                    tensor.shape.end(), Index{1},
                                                                    std::multiplies<>()));
        require(all_finite(values), Exit::kFailure, "model not written: tensor ",
                quoted(tensor.name),
                " is not finite: the recordings' numbers are beyond what can be learned, or the "
                "training diverged (lower training.lr)");
        entry.dtype = dtype_of(values);
        entry.end = begin + values.size() * sizeof(values[0]);
      },
      tensor.values);
  return entry;
}

template <class T>
std::vector<T> load_values(std::string_view bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = load_little<T>(bytes.data() + i * sizeof(T));
  }
  return values;
}

StoredTensor load_tensor(const TensorEntry& entry, std::string_view data,
                         const std::string& where) {
  const auto bytes = data.substr(entry.begin, entry.end - entry.begin);
  StoredTensor tensor{.name = entry.name, .shape = entry.shape, .values = {}};
  if (entry.dtype == "F32") tensor.values = load_values<float>(bytes);
  if (entry.dtype == "F64") tensor.values = load_values<double>(bytes);
  if (entry.dtype == "I64") tensor.values = load_values<std::int64_t>(bytes);
  if (!std::visit([](const auto& values) { return all_finite(values); }, tensor.values)) {
    reject_model(where, "tensor " + quoted(entry.name) + " has a value that is not finite");
  }
  return tensor;
}

/// The header's text, after the checks that need nothing but lengths.
std::string_view header_of(std::string_view bytes, const std::string& where) {
  if (bytes.size() < kLengthBytes) reject_model(where, "too short for a model file");
  const auto length = load_little<std::uint64_t>(bytes.data());
  if (length > kMaxHeaderBytes || length > bytes.size() - kLengthBytes) {
    reject_model(where, "not a model file, or cut off");
  }
  return bytes.substr(kLengthBytes, length);
}

void check_digest(std::string_view bytes, std::string_view text, const ContainerHeader& header,
                  const std::string& where) {
  const auto given = header.metadata.find(kDigestKey);
  if (given == header.metadata.end() || given->second.size() != kDigestDigits) {
    reject_model(where, "has no SHA-256 checksum");
  }
  if (digest(bytes, kLengthBytes + digits_place(text)) != given->second) {
    reject_model(where, "its SHA-256 checksum is wrong");
  }
}

}  // namespace

const StoredTensor* Container::find(const std::string& name) const {
  for (const auto& tensor : tensors) {
    if (tensor.name == name) return &tensor;
  }
  return nullptr;
}

std::string encode(const Container& container) {
  ContainerHeader header{.metadata = container.metadata, .tensors = {}};
  header.metadata[kDigestKey] = std::string(kDigestDigits, '0');
  std::uint64_t place = 0;
  for (const auto& tensor : container.tensors) {
    assert(container.find(tensor.name) == &tensor);  // names are unique
    header.tensors.push_back(describe(tensor, place));
    place = header.tensors.back().end;
  }
  const std::string text = header_text(header);
  require(text.size() <= kMaxHeaderBytes && header.tensors.size() <= kMaxTensors, Exit::kFailure,
          "model not written: its description is larger than a model file may have");
  std::string bytes;
  bytes.reserve(kLengthBytes + text.size() + place);
  append_little(bytes, std::uint64_t{text.size()});
  bytes += text;
  for (const auto& tensor : container.tensors) {
    std::visit(
        [&](const auto& values) {
          for (const auto value : values) append_little(bytes, value);
        },
        tensor.values);
  }
  const auto digits = kLengthBytes + digits_place(text);
  return bytes.replace(digits, kDigestDigits, digest(bytes, digits));
}

Container decode(std::string_view bytes, const std::string& where) {
  const auto text = header_of(bytes, where);
  const auto data = bytes.substr(kLengthBytes + text.size());
  const auto header = parse_header(text, data.size(), where);
  check_digest(bytes, text, header, where);
  Container container{.metadata = header.metadata, .tensors = {}};
  for (const auto& entry : header.tensors) {
    container.tensors.push_back(load_tensor(entry, data, where));
  }
  return container;
}

void write_container(const std::filesystem::path& path, const Container& container) {
  write_file(path, encode(container));
}

Container read_container(const std::filesystem::path& path) {
  return decode(read_file(path, kMaxFileBytes, Exit::kModel), path.string());
}

}  // namespace dcnn
