// Laws for what no effect of the catalogue explains, as part of the corrected model and its report.
#pragma once

#include "dcnn/discovery/discover.h"
#include "diagnosis/holdout.h"

namespace dcnn {

/// Takes back the names along an axis, together of more numbers than the simplest law has, where
/// one established law without a name in their place gains more than they do by what any law must
/// gain to be accepted, and by the price of the numbers that it has more.
void prefer_one_law(Search& search);

/// Where something unnamed remains: looks for laws in the residual (dcnn/discovery), puts them
/// beside the names, looks for further names beside both, and for the laws again beside those. The
/// laws that then stand in the fit, in their order; none where none is found.
std::vector<discovery::Discovered> add_discovered(Search& search);

/// Takes back laws that held-out data make less probable than not, the least probable first, as
/// leave_refuted() does names; `unnamed` is the probability of each before: that something which no
/// name explains acts.
Json leave_refuted_laws(Search& search, const HoldOut& holdout, double unnamed,
                        std::vector<discovery::Discovered>& laws);

/// Laws of the fit as findings.
Json law_findings(const Search& search, const std::vector<discovery::Discovered>& laws,
                  const HoldOut& holdout);

}  // namespace dcnn
