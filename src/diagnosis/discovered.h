// SPDX-License-Identifier: Apache-2.0
// Laws for what no effect of the catalogue explains, as part of the corrected model and its report.
#pragma once

#include "dcnn/discovery/discover.h"
#include "diagnosis/holdout.h"

namespace dcnn {

/// Where one law explains more than several names along an axis do, and predicts what was held out
/// as well, it stands in their place. Where something unnamed remains, laws are looked for in the
/// residual (dcnn/discovery). Beside laws further names are looked for, and the laws again beside
/// those. The laws that then stand in the fit, in their order; none where none is found.
std::vector<discovery::Discovered> add_discovered(Search& search, const HoldOut& holdout);

/// Takes back laws that held-out data speak against, or the error of which they raise, the least
/// probable first: the fitted rows say that something acts, and the others alone whether it has
/// this form, at even odds before.
Json leave_refuted_laws(Search& search, const HoldOut& holdout,
                        std::vector<discovery::Discovered>& laws);

/// Laws of the fit as findings.
Json law_findings(const Search& search, const std::vector<discovery::Discovered>& laws,
                  const HoldOut& holdout);

/// What no name explains: by channel, in the band where it is (`bands`, before any law), and in a
/// formula, which `suffices` where its form holds and held-out data show nothing beside it; or that
/// the held-out data refute that all is explained.
Json unnamed_part(const Search& search, const std::vector<BandTest>& bands, const Json& laws,
                  const std::optional<HoldOut::Excess>& refuted, bool held_out);

}  // namespace dcnn
