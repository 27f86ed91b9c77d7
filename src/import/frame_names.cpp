// SPDX-License-Identifier: Apache-2.0
#include "import/frame_names.h"

#include <algorithm>
#include <cctype>

#include "import/candidates.h"
#include "import/roles.h"

namespace dcnn {
namespace {

/// Words with the one at `at` replaced by a letter.
bool has_sibling(const LogStream& stream, std::vector<std::string> words, std::size_t at,
                 char letter) {
  words[at] = std::string(1, letter);
  return std::any_of(stream.channels.begin(), stream.channels.end(),
                     [&](const auto& channel) { return words_of_name(channel.name) == words; });
}

}  // namespace

std::string matrix_word(const LogStream& stream, const std::string& channel) {
  constexpr std::size_t kName = 3;  // T12
  const std::string own = channel.substr(channel.find_last_of("./") + 1);
  if (own.size() != kName || std::isalpha(static_cast<unsigned char>(own[0])) == 0) return "";
  const std::string before = channel.substr(0, channel.size() - 2);
  const char first = stream.find(before + "00") >= 0 ? '0' : '1';
  const bool three = stream.find(before + (first == '0' ? "22" : "33")) >= 0;
  if (!three || stream.find(before + (first == '0' ? "21" : "32")) < 0) return "";
  // No matrix of a frame has a fifth column: c11 to c33 are columns that are counted.
  if (stream.find(before + (first == '0' ? "04" : "15")) >= 0) return "";
  const int row = own[1] - first, column = own[2] - first;
  if (row < 0 || row > 2 || column < 0 || column > 3) return "";
  if (column == 3) return std::string(1, "xyz"[row]);
  return "r" + std::to_string(row + 1) + std::to_string(column + 1);
}

std::string kuka_word(const LogStream& stream, const std::vector<std::string>& words) {
  for (std::size_t at = 0; at < words.size() && words.size() <= 2; ++at) {
    if (words[at].size() != 1 || std::string("xyzabc").find(words[at]) == std::string::npos) {
      continue;
    }
    bool all = true;
    for (const char letter : {'x', 'y', 'z', 'a', 'b', 'c'}) {
      all = all && has_sibling(stream, words, at, letter);
    }
    if (!all) continue;
    if (words[at] == "a") return "alpha";
    if (words[at] == "b") return "beta";
    return words[at] == "c" ? "gamma" : words[at];
  }
  return "";
}

int elements_beside(const LogStream& stream, const std::string& channel) {
  constexpr int kMostElements = 16;
  const auto name = counted(channel);
  if (!name) return 0;
  int count = 0;
  for (int k = 0; k <= kMostElements; ++k) {
    count += stream.find(name->before + std::to_string(k) + name->after) >= 0 ? 1 : 0;
  }
  return count;
}

}  // namespace dcnn
