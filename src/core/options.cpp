#include "dcnn/core/options.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "dcnn/core/excerpt.h"

namespace dcnn {

Options::Options(Json object, std::string where, Exit exit)
    : object_(std::move(object)), where_(std::move(where)), exit_(exit) {
  if (object_.is_null()) object_ = Json::object();
  require(object_.is_object(), exit_, where_, ": must be a JSON object, not ", excerpt(object_.dump()));
}

bool Options::has(const std::string& key) const { return object_.contains(key); }

double Options::number(const std::string& key, double fallback, double low, double high) {
  const double value = get(key, fallback);
  if (!(value >= low && value <= high)) {
    reject(key, "must be between ", low, " and ", high, ", not ", value);
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
  if (!value.is_null() && !value.is_object()) reject(key, "must be an object, not ", excerpt(value.dump()));
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

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t swap = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({swap, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& words) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const auto& candidate : words) {
    const auto distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace dcnn
