// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/heard.h"

#include <algorithm>

#include "core/elementary.h"
#include "diagnosis/detectors.h"

namespace dcnn {

std::optional<double> take_hum_for_noise(Search& search, const HoldOut& holdout) {
  const std::vector<Member>& members = search.fit().members;
  const auto hum = std::find_if(members.begin(), members.end(), is_heard_hum);
  if (hum == members.end() || holdout.empty()) return std::nullopt;
  const double hz = hum->shapes(0);
  std::vector<Member> others = members;
  std::erase_if(others, is_heard_hum);
  const Signals with = holdout.prediction(members, search.fit().base);
  const Signals without = holdout.prediction(others, search.fit().base);
  if (holdout.log_support(with, without, search.floors()) > 0.0) return std::nullopt;
  search.leave_hum();
  return hz;
}

Json leave_refuted_impacts(Search& search, const HoldOut& holdout) {
  if (!search.loose_load()) return Json::array();
  const double support = holdout.support_of_impacts(search);
  if (support >= 0.0) return Json::array();
  const Member loose_load = *search.loose_load();
  search.leave_impacts();
  return Json::array({{{"effect", loose_load.name()},
                       {"axis", loose_load.axis},
                       {"confidence", 1.0 / (1.0 + elementary::exp(-support))}}});
}

}  // namespace dcnn
