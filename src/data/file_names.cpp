// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/file_names.h"

#include <algorithm>

namespace dcnn {
namespace {

std::filesystem::path last_parts(const std::filesystem::path& file, std::ptrdiff_t parts) {
  const std::filesystem::path plain = file.lexically_normal();
  const auto all = std::distance(plain.begin(), plain.end());
  std::filesystem::path last;
  for (auto part = std::next(plain.begin(), std::max<std::ptrdiff_t>(0, all - parts));
       part != plain.end(); ++part) {
    last /= *part;
  }
  return last;
}

}  // namespace

std::string distinct_name(const std::filesystem::path& file,
                          const std::vector<std::filesystem::path>& list) {
  const std::filesystem::path whole = file.lexically_normal();
  std::ptrdiff_t parts = 1;
  const auto is_another = [&](const std::filesystem::path& other) {
    return other.lexically_normal() != whole && last_parts(other, parts) == last_parts(file, parts);
  };
  while (parts < std::distance(whole.begin(), whole.end()) &&
         std::any_of(list.begin(), list.end(), is_another)) {
    ++parts;
  }
  return last_parts(file, parts).string();
}

}  // namespace dcnn
