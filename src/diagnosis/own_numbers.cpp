#include "diagnosis/own_numbers.h"

#include <algorithm>

#include "diagnosis/candidates.h"
#include "diagnosis/confidence.h"

namespace dcnn {

Json begin_with_own_numbers(Search& search, const HoldOut& holdout) {
  const Case& study = search.study();
  if (study.axis || holdout.empty()) return Json::array();
  std::vector<Member> own = own_parameters(study);
  std::erase_if(own, [&](const Member& m) { return !is_listed(study, *m.kind); });
  const std::vector<Member> found = search.fit().members;
  const bool others = std::any_of(found.begin(), found.end(), [&](const Member& m) {
    return std::none_of(own.begin(), own.end(), [&](const Member& o) { return o.kind == m.kind; });
  });
  if (own.empty() || !others) return Json::array();
  const Signals by_found = holdout.prediction(found, search.fit().base);
  const auto is_better = [&](const JointFit& fit) {
    const Signals predicted = holdout.prediction(fit.members, fit.base);
    return holdout.log_support(predicted, by_found, search.floors()) > 0.0;
  };
  const JointFit alone = joint_fit(search.setting(), std::move(own));
  if (!is_better(alone)) return Json::array();
  search.begin_with(alone.members);
  Json refuted = leave_refuted(search, holdout);
  if (is_better(search.fit())) return refuted;
  search.hold(found);
  search.adopt(found);
  return Json::array();
}

}  // namespace dcnn
