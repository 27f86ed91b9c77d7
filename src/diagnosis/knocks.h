// A load that slides between stops.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/case.h"
#include "diagnosis/member.h"
#include "diagnosis/search.h"

namespace dcnn {

struct Knocks {
  std::optional<Member> member;  ///< loose_load, with the numbers that were found
  std::vector<Span> spans;       ///< when it slides and knocks
};

/// Listens for what a load between stops must do under the field along an axis: let go when the
/// field exceeds its dry friction, slide, knock with a known speed, rebound. Gap, friction and
/// rebound are those whose knocks are heard best, the slug is the momentum over the speed. Heard is
/// what stands out from the same sum at other times.
Knocks find_knocks(const Case& study, const Signals& left);

}  // namespace dcnn
