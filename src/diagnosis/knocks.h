// A load that slides between stops.
#pragma once

#include <optional>
#include <vector>

#include "diagnosis/case.h"
#include "diagnosis/member.h"
#include "diagnosis/scan.h"
#include "diagnosis/slug.h"
#include "diagnosis/span.h"

namespace dcnn {

struct Knocks {
  std::optional<Member> member;  ///< loose_load, with the numbers that were found
  std::vector<Span> spans;       ///< when it slides and knocks
  int component = 0;             ///< of the force in which they are heard: 0, 1, 2 for x, y, z
  /// What was tried, the mass that is heard best in it [kg], and how likely it is among all.
  struct Tried {
    Slug slug;
    double mass, probability;
  };
  std::vector<Tried> tried;
};

/// Listens for what a load between stops must do under the field along an axis: let go when the
/// field exceeds its dry friction, slide, knock with a known speed, rebound. Gap, friction and
/// rebound are those whose knocks are heard best, the slug is the momentum over the speed. Heard is
/// what stands out from the same sum at other times.
Knocks find_knocks(const Case& study, const Signals& left);

/// ln of the factor by which other recordings, of which this is left, change the odds of the knocks
/// against none: the mean of what was tried.
double knocks_support(const Case& recordings, const Signals& left, const Knocks& knocks);

}  // namespace dcnn
