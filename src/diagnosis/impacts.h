// SPDX-License-Identifier: Apache-2.0
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

struct Impacts {
  std::optional<Member> member;  ///< loose_load, with the numbers that were found
  std::vector<Span> spans;       ///< from the start of each slide to the end of its impacts
  /// A point of the search grid, the moving mass that is likeliest there [kg], and its posterior
  /// probability over the grid.
  struct Tried {
    Slug slug;
    double mass, probability;
  };
  std::vector<Tried> tried;
};

/// Listens for what a load between stops must do under the field along an axis: let go when the
/// field exceeds its dry friction, slide, strike the stop with a known speed, rebound. Gap,
/// friction and rebound are those whose impacts are heard best, the slug is the momentum over the
/// speed. Heard is what stands out from the same sum at other times.
Impacts find_impacts(const Case& study, const Signals& left);

/// ln of the Bayes factor of the impacts against none from other recordings, of which these are the
/// residuals: the posterior mean of the likelihood ratio over the search grid.
double impacts_support(const Case& recordings, const Signals& left, const Impacts& impacts);

}  // namespace dcnn
