// SPDX-License-Identifier: Apache-2.0
// The search of a machine that mostly stands still.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "diagnosis/load.h"
#include "diagnosis/search.h"

namespace dcnn {

/// A search that has run. Rows at rest decide nothing, for friction there is any force up to the
/// one that breaks loose (rest.h). Of a machine that mostly stands still they hold most of what is
/// known of its weights and springs: where without them something is left, a search in which they
/// count takes its place if it predicts the moving rows of what was held out better (kLikelier),
/// and they count in `loaded` from then on.
std::unique_ptr<Search> searched(LoadedCase& loaded, const std::vector<Span>& held_out,
                                 const std::function<void(const std::string&)>& progress);

}  // namespace dcnn
