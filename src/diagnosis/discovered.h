// Laws for what no effect of the catalogue explains, as part of the corrected model and its report.
#pragma once

#include "diagnosis/holdout.h"

namespace dcnn {

/// Takes back the names along an axis, together of more numbers than the simplest law has, where
/// one established law without a name in their place gains more than they do, each number at its
/// price, by what any law must gain to be accepted.
void prefer_one_law(Search& search);

/// Where the search says that something unnamed remains: looks for laws in the residual
/// (dcnn/discovery), fits the named effects again beside them, and adds the laws to the findings,
/// the hold-out errors, the noise, and the model. Leaves everything as it is where no law is found.
void add_discovered(Search& search, const HoldOut& holdout, Diagnosis& diagnosis);

}  // namespace dcnn
