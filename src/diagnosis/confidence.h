// How probable the names are once the held-out data have been seen, which can only take names back.
#pragma once

#include "diagnosis/holdout.h"
#include "diagnosis/search.h"

namespace dcnn {

/// Probability of a member that was fitted: its mass among the weighed structures, updated by what
/// the held-out data say of the fit with it against the fit without it.
double confidence(const Search& search, const HoldOut& holdout, std::size_t member);

/// Takes back, the least probable first, names that are less probable than not: each as
/// {effect, axis, confidence}.
Json leave_refuted(Search& search, const HoldOut& holdout);

}  // namespace dcnn
