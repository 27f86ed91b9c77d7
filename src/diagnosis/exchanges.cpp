// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/exchanges.h"

namespace dcnn {

void Exchanges::made(const std::vector<Member>& names, const Alternative& other) {
  log_odds_[{places_of(names), places_of(other.members)}] = other.log_odds;
}

void Exchanges::make_symmetric(const std::vector<Member>& names,
                               std::vector<std::vector<Alternative>>& alternatives) const {
  for (auto& of_member : alternatives) {
    for (Alternative& other : of_member) {
      const auto before = log_odds_.find({places_of(other.members), places_of(names)});
      if (before != log_odds_.end()) other.log_odds = 0.5 * (other.log_odds - before->second);
    }
  }
}

}  // namespace dcnn
