// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/options.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <utility>

#include "dcnn/core/excerpt.h"

namespace dcnn {

namespace {

/// Whole numbers without an exponent.
std::string plain(double value) {
  constexpr double kMostDigits = 1e19;
  std::ostringstream text;
  if (value == std::round(value) && std::abs(value) < kMostDigits)
    text << std::fixed << std::setprecision(0);
  text << value;
  return text.str();
}

}  // namespace

Options::Options(Json object, std::string where, Exit exit)
    : object_(std::move(object)), where_(std::move(where)), exit_(exit) {
  if (object_.is_null()) object_ = Json::object();
  require(object_.is_object(), exit_, where_, ": must be a JSON object, not ",
          excerpt(object_.dump()));
}

bool Options::has(const std::string& key) const { return object_.contains(key); }

double Options::number(const std::string& key, double fallback, double low, double high) {
  const double value = get(key, fallback);
  if (!(value >= low && value <= high)) {
    reject(key, "must be between ", plain(low), " and ", plain(high), ", not ", plain(value));
  }
  return value;
}

std::string Options::choice(const std::string& key, const std::string& fallback,
                            const std::vector<std::string>& words) {
  const std::string value = get(key, fallback);
  if (std::find(words.begin(), words.end(), value) == words.end()) {
    std::string list;
    for (const auto& word : words) list += (list.empty() ? "" : ", ") + word;
    reject(key, "must be one of ", list, ", not '", value, "'");
  }
  return value;
}

Options Options::child(const std::string& key) {
  const Json value = raw(key);
  if (!value.is_null() && !value.is_object())
    reject(key, "must be an object, not ", excerpt(value.dump()));
  Options child(value, where_, exit_);
  child.prefix_ = path(key) + ".";
  return child;
}

Json Options::raw(const std::string& key) {
  known_.insert(key);
  return has(key) ? object_.at(key) : Json();
}

void Options::finish() const {
  for (const auto& [key, value] : object_.items()) {
    if (known_.count(key)) continue;
    const auto near = nearest_word(key, {known_.begin(), known_.end()});
    reject(key, "is unknown", near.empty() ? "" : "; did you mean '" + near + "'?");
  }
}

std::string Options::path(const std::string& key) const { return prefix_ + excerpt(key); }

namespace {

/// Insertions, deletions, substitutions and swaps of neighbours that make one of the other (optimal
/// string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before, row(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      next[j] = std::min({row[j - 1] + (a[i - 1] != b[j - 1]), row[j] + 1, next[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) next[j] = std::min(next[j], before[j - 2] + 1);
    }
    before = std::exchange(row, next);
  }
  return row[b.size()];
}

/// Without the dashes before an option.
std::string letters_of(const std::string& word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

/// Whether one word, of three letters or more, begins the other.
bool is_beginning(const std::string& a, const std::string& b) {
  return std::min(a.size(), b.size()) >= 3 && (a.starts_with(b) || b.starts_with(a));
}

}  // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& words) {
  const std::string typed = letters_of(word);
  // One slip for every four letters: more make another word of a short one.
  std::size_t least = (typed.size() + 1) / 4 + 1;
  std::string best;
  for (const auto& candidate : words) {
    const std::string meant = letters_of(candidate);
    const std::size_t slips = is_beginning(typed, meant) ? 1 : edit_distance(typed, meant);
    if (slips < least) {
      least = slips;
      best = candidate;
    }
  }
  return best;
}

}  // namespace dcnn
