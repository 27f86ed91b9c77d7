// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/posterior_json.h"

namespace dcnn::evidence {

Json posterior_json(const Posterior& p) {
  return {{"nothing", p.nothing},
          {"named", p.named},
          {"named_and_unknown", p.named_and_unknown},
          {"unknown", p.unknown}};
}

Json structures_json(const Posterior& p) {
  Json list = Json::array();
  for (std::size_t k = 0; k < p.structures.size(); ++k) {
    const Structure& s = p.structures[k];
    Json names = Json::array();
    for (const Member& m : s.members)
      names.push_back(m.name() + (m.axis.empty() ? "" : " " + m.axis));
    list.push_back({{"effects", names},
                    {"mass", p.without_unknown[k]},
                    {"mass_with_unknown", p.with_unknown[k]},
                    {"log_evidence", s.log_named},
                    {"log_slow_noise", s.noise.log_factor},
                    {"log_unknown", s.unknown.log_factor},
                    {"unknown", s.unknown.words}});
  }
  return list;
}

}  // namespace dcnn::evidence
