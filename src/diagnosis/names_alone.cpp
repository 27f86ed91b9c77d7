// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/names_alone.h"

#include <algorithm>

#include "diagnosis/evidence/priors.h"

namespace dcnn {

NamesAlone::NamesAlone(Search& search, const HoldOut& holdout)
    : search_(search),
      holdout_(holdout),
      members_(search.fit().members),
      prediction_(holdout.prediction(members_, search.fit().base)) {}

void NamesAlone::put_back() const {
  search_.hold(members_);  // no law among them
  search_.adopt(members_);
}

bool NamesAlone::are_kept() const {
  const std::vector<Member>& now = search_.fit().members;
  return std::all_of(members_.begin(), members_.end(), [&](const Member& name) {
    return name.fixed || std::any_of(now.begin(), now.end(), [&](const Member& other) {
             return other.kind == name.kind && other.axis == name.axis;
           });
  });
}

bool NamesAlone::give_way_to(const Laws& laws) const {
  const Signals by_laws = holdout_.prediction(search_.fit().members, search_.fit().base);
  if (holdout_.log_support(by_laws, prediction_, search_.floors()) < 0.0) return false;
  const std::vector<Floor> floors = holdout_.floors(search_);
  if (are_kept() || (are_established(laws) && !holdout_.excess(search_, floors))) return true;
  Eigen::VectorXd noise(static_cast<Index>(floors.size()));
  for (std::size_t j = 0; j < floors.size(); ++j) {
    noise(static_cast<Index>(j)) = floors[j].whole_deviation() * floors[j].whole_deviation();
  }
  return holdout_.share_explained(by_laws, prediction_, noise, 1) > prior::kInPlaceOfName;
}

}  // namespace dcnn
