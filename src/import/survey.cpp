// SPDX-License-Identifier: Apache-2.0
// What is worth its memory while nothing is decided yet.
#include <algorithm>

#include "dcnn/import/recipe.h"
#include "import/candidates.h"
#include "import/roles.h"

namespace dcnn {

std::function<bool(const LogStream&, const std::string& channel)> worth_keeping(
    const ImportWishes& wishes) {
  return [&wishes](const LogStream& stream, const std::string& channel) {
    if (stream.type == "text" || stream.type == "array") return true;
    if (!role_of(stream, channel).empty()) return true;
    if (clock_rank(channel) > 1) return true;
    const auto is_named = [&](const std::string& spec) {
      return spec == channel || spec == stream.name + ":" + channel;
    };
    for (const auto& [to, spec] : wishes.map) {
      if (is_named(spec) || may_follow(spec, channel) ||
          may_follow(spec, stream.name + ":" + channel)) {
        return true;
      }
    }
    for (const std::string& spec : wishes.also) {
      if (is_named(spec)) return true;
    }
    return std::any_of(wishes.clock.begin(), wishes.clock.end(), is_named);
  };
}

}  // namespace dcnn
