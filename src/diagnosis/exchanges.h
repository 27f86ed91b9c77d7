// SPDX-License-Identifier: Apache-2.0
// Names that took the place of others, and what was said for it.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>

#include "diagnosis/search.h"

namespace dcnn {

/// Two sets of names are compared by the noise that the set at hand leaves. By that of the other
/// the comparison may come out otherwise, and each be exchanged for the other again and again:
/// where both were seen, the mean of both counts, which is the same from either side.
class Exchanges {
 public:
  /// These names gave way to an alternative.
  void made(const std::vector<Member>& names, const Alternative& other);
  /// log_odds of the alternatives to the names at hand, where these took their place before.
  void make_symmetric(const std::vector<Member>& names,
                      std::vector<std::vector<Alternative>>& alternatives) const;

 private:
  using Places = std::multiset<std::string>;
  std::map<std::pair<Places, Places>, double> log_odds_;  // of the second over the first
};

}  // namespace dcnn
