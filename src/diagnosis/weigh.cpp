// The structures that the judgement leaves: the members, each without some of them, with and
// without an unknown.
#include <algorithm>

#include "diagnosis/search.h"

namespace dcnn {
namespace {

constexpr std::size_t kAllSubsets = 3;  // members up to which every subset is weighed

/// Which of `count` members a structure holds: all subsets of few, else all but one and none.
std::vector<std::vector<bool>> choices(std::size_t count) {
  std::vector<std::vector<bool>> list;
  if (count <= kAllSubsets) {
    for (std::size_t bits = 0; bits < std::size_t{1} << count; ++bits) {
      list.emplace_back();
      for (std::size_t k = 0; k < count; ++k) list.back().push_back((bits >> k) & 1);
    }
    return list;
  }
  list.emplace_back(count, true);
  list.emplace_back(count, false);
  for (std::size_t k = 0; k < count; ++k) {
    list.emplace_back(count, true);
    list.back()[k] = false;
  }
  return list;
}

}  // namespace

void Search::weigh() {
  say("weighing what was found against nothing and against what nobody can name");
  std::vector<Member> free = fit_.members;
  std::erase_if(free, [](const Member& m) { return m.fixed; });
  const evidence::Grid grid(*setting_);
  std::vector<evidence::Structure> structures;
  for (const std::vector<bool>& chosen : choices(free.size())) {
    std::vector<Member> members = apart_;
    for (std::size_t k = 0; k < free.size(); ++k) {
      if (chosen[k]) members.push_back(free[k]);
    }
    structures.push_back(evidence::structure_of(*setting_, grid, joint_fit(*setting_, members)));
  }
  posterior_ = evidence::posterior_of(std::move(structures), rounding_ || knocking_);
}

}  // namespace dcnn
