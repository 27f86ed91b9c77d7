#include "diagnosis/confidence.h"

namespace dcnn {

double confidence(const Search& search, const HoldOut& holdout, std::size_t member) {
  return evidence::updated(
      search.posterior().inclusion(search.fit().members[member]),
      holdout.log_support(search.fit(), search.without(member), search.floors()));
}

Json leave_refuted(Search& search, const HoldOut& holdout) {
  Json refuted = Json::array();
  while (true) {
    double least = 0.5;
    std::optional<std::size_t> worst;
    for (std::size_t m = 0; m < search.fit().members.size(); ++m) {
      if (search.fit().members[m].fixed) continue;
      const double p = confidence(search, holdout, m);
      if (p < least) least = p, worst = m;
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
