// SPDX-License-Identifier: Apache-2.0
// How likely each name is, in the light of what was held out.
#pragma once

#include "diagnosis/holdout.h"

namespace dcnn {

/// The probability of a member that was `before`, after what the held-out data say of the model
/// with it, which predicts `with`, and without it.
double supported(double before, const Search& search, const HoldOut& holdout, const Signals& with,
                 std::size_t member);

/// The probability of each member of a finished search: the share of the weighed structures that
/// have it, its odds multiplied by what the held-out data say for or against it. Of a member that
/// is fixed none: a test of its own found it.
std::vector<std::optional<double>> confidences(const Search& search, const HoldOut& holdout);

/// Channels in which held-out data speak against a member that all channels together bear out, and
/// how probable it is by the one that does so most: a law holds in every channel or is another.
struct Contradicted {
  std::vector<std::size_t> channels;
  double probability = 1.0;
};
std::vector<Contradicted> contradicted(const Search& search, const HoldOut& holdout);

/// Of a member and of other effects in its place, which the recordings cannot exclude: their shares
/// of the mass of all, by their evidence and what the held-out data say for or against each; the
/// member's own first.
std::vector<double> masses_of(const Search& search, const std::vector<Alternative>& alternatives);

/// Puts an effect in the place of a member where it is twice as likely, by masses_of(), or makes
/// the same force and stands before it in the catalogue: the alternatives to what then stands.
std::vector<std::vector<Alternative>> adopt_likelier(Search& search, const HoldOut& holdout);

/// Takes back, the least likely first, the names that are rather wrong than right by the held-out
/// data too: what they were, and how likely.
Json leave_refuted(Search& search, const HoldOut& holdout);

/// Takes from dry friction of gears the variation with the position that held-out data refute: the
/// friction without it predicts them better. Whether there was such.
bool leave_refuted_variations(Search& search, const HoldOut& holdout);

}  // namespace dcnn
