// SPDX-License-Identifier: Apache-2.0
// The corrected simulator where it runs sample by sample.
#pragma once

#include "diagnosis/search.h"

namespace dcnn {

/// The causal derivative by which a model of a tool errs least on its own recordings: a long window
/// lags, a short one passes the noise of the pose. None where a model needs no motion (poses at
/// rest), is of another machine, or needs columns of the log.
std::optional<DerivativeSpec> best_online(const Search& search);

/// The case with its motion by this derivative.
Case by_derivative(Case study, const DerivativeSpec& derivative);

}  // namespace dcnn
