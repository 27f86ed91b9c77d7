// Laws for what no effect of the catalogue explains, as part of the corrected model and its report.
#pragma once

#include "diagnosis/holdout.h"

namespace dcnn {

/// Where the search says that something unnamed remains: looks for laws in the residual
/// (dcnn/discovery), fits the named effects again beside them, and adds the laws to the findings,
/// the hold-out errors, and the model. Leaves everything as it is where no law is found.
void add_discovered(const Search& search, const HoldOut& holdout, Diagnosis& diagnosis);

}  // namespace dcnn
