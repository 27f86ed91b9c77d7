// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/own_numbers.h"

#include <algorithm>

#include "diagnosis/candidates.h"
#include "diagnosis/confidence.h"
#include "diagnosis/evidence/priors.h"

namespace dcnn {
namespace {

/// Mean square error on what was held out, in variances of each channel's noise.
double error_of(const Search& search, const HoldOut& holdout, const JointFit& fit) {
  const std::vector<double> rmse = holdout.rmse(fit.members, fit.base);
  double sum = 0.0;
  for (std::size_t j = 0; j < rmse.size(); ++j) {
    const double noise = std::max(search.floors()[j].deviation(), 1e-300);
    sum += rmse[j] * rmse[j] / (noise * noise);
  }
  return sum / static_cast<double>(rmse.size());
}

}  // namespace

Json take_own_numbers(Search& search, const HoldOut& holdout) {
  const Case& study = search.study();
  if (study.axis || holdout.empty()) return Json::array();
  std::vector<Member> own = own_parameters(study);
  std::erase_if(own, [&](const Member& m) { return !is_listed(study, *m.kind); });
  const std::vector<Member> found = search.fit().members;
  if (own.empty()) return Json::array();
  const JointFit alone = joint_fit(search.setting(), std::move(own));
  const JointFit given = joint_fit(search.setting(), {});
  const Signals by_found = holdout.prediction(found, search.fit().base);
  const auto is_better = [&](const JointFit& fit) {
    const Signals predicted = holdout.prediction(fit.members, fit.base);
    return holdout.log_support(predicted, by_found, search.floors()) > 0.0;
  };
  // Of a law that is none of them they explain a part.
  const double most = prior::kNothing * error_of(search, holdout, given);
  const bool explain = error_of(search, holdout, alone) <= most;
  // One that these recordings do not show, as a tilt about an axis that gravity hardly leaves, may
  // spoil the others on new ones: they are looked at without those that are refuted too.
  const bool may_explain =
      explain ? is_better(alone) : holdout.excess(search, holdout.floors(search)).has_value();
  if (!may_explain) return Json::array();
  search.begin_with(alone.members);
  Json refuted = leave_refuted(search, holdout);
  const bool still = explain || error_of(search, holdout, search.fit()) <= most;
  if (still && is_better(search.fit())) {
    // What acts beside them was looked for beside other names.
    if (search.remains()) search.add_beside();
    for (const Json& name : leave_refuted(search, holdout)) refuted.push_back(name);
    return refuted;
  }
  search.adopt(found);
  return Json::array();
}

}  // namespace dcnn
