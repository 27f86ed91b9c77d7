#include "diagnosis/confidence.h"

#include "diagnosis/evidence/posterior.h"

namespace dcnn {

std::vector<std::optional<double>> confidences(const Search& search, const HoldOut& holdout) {
  const JointFit& fit = search.fit();
  const Signals with = holdout.prediction(fit.members, fit.base);
  std::vector<std::optional<double>> list;
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    list.emplace_back();
    if (fit.members[m].fixed) continue;
    const JointFit& rest = search.without(m);
    const Signals without = holdout.prediction(rest.members, rest.base);
    list.back() = evidence::updated(search.posterior().inclusion(fit.members[m]),
                                    holdout.log_support(with, without, search.floors()));
  }
  return list;
}

Json leave_refuted(Search& search, const HoldOut& holdout) {
  Json refuted = Json::array();
  while (true) {
    double least = 0.5;
    std::optional<std::size_t> worst;
    const auto likely = confidences(search, holdout);
    for (std::size_t m = 0; m < likely.size(); ++m) {
      if (likely[m] && *likely[m] < least) least = *likely[m], worst = m;
    }
    if (!worst) return refuted;
    const Member& member = search.fit().members[*worst];
    refuted.push_back({{"effect", member.name()},
                       {"axis", member.axis.empty() ? Json() : Json(member.axis)},
                       {"confidence", least}});
    search.leave_out({*worst});
  }
}

}  // namespace dcnn
