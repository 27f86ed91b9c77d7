// SPDX-License-Identifier: Apache-2.0
// Reading a JSON object key by key: defaults, types, and an error for every key nobody asked for.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn {

/// A view of one JSON object that remembers which keys were read.
///
///   Options options(json, "train.json", Exit::kUsage);
///   const int batch = options.get("batch", 50);
///   options.finish();                                // unknown key: error with a suggestion
///
/// Every fault is an Error with the code given at construction, naming the file and the key's path.
class Options {
 public:
  Options(Json object, std::string where, Exit exit);

  bool has(const std::string& key) const;

  /// The value of a key that must be there.
  template <class T>
  T get(const std::string& key) {
    require(has(key), exit_, where_, ": key '", path(key), "' is missing");
    return convert<T>(key);
  }

  /// The value of a key, or `fallback` where it is absent.
  template <class T>
  T get(const std::string& key, T fallback) {
    known_.insert(key);
    return has(key) ? convert<T>(key) : fallback;
  }

  /// A number that must lie in [low, high].
  double number(const std::string& key, double fallback, double low, double high);

  /// One of the given words.
  std::string choice(const std::string& key, const std::string& fallback,
                     const std::vector<std::string>& words);

  /// The object under a key (empty where it is absent); finish() it on its own.
  Options child(const std::string& key);

  /// The raw value under a key, null where it is absent.
  Json raw(const std::string& key);

  /// Every key was asked for; otherwise an Error that suggests the nearest known one.
  void finish() const;

  /// Fails naming this object's file and the key's path.
  template <class... Parts>
  [[noreturn]] void reject(const std::string& key, const Parts&... parts) const {
    fail(exit_, where_, ": key '", path(key), "' ", parts...);
  }

 private:
  template <class T>
  T convert(const std::string& key) {
    known_.insert(key);
    const Json& value = object_.at(key);
    check_kind<T>(key, value);
    try {
      return value.get<T>();
    } catch (const Json::exception&) {
      reject(key, "has the wrong type: ", value.dump());
    }
  }

  // The library turns 1.5 into 1 and true into 1 without a word.
  template <class T>
  void check_kind(const std::string& key, const Json& value) const {
    if constexpr (std::is_same_v<T, bool>) {
      if (!value.is_boolean()) reject(key, "must be true or false, not ", value.dump());
    } else if constexpr (std::is_integral_v<T>) {
      if (!value.is_number_integer()) reject(key, "must be a whole number, not ", value.dump());
    } else if constexpr (std::is_floating_point_v<T>) {
      if (!value.is_number()) reject(key, "must be a number, not ", value.dump());
    }
  }

  std::string path(const std::string& key) const;

  Json object_;
  std::string where_;   // the file
  std::string prefix_;  // the path of this object in it
  Exit exit_;
  std::set<std::string> known_;
};

/// The word of `words` nearest to `word` by edit distance, empty when none is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& words);

}  // namespace dcnn
