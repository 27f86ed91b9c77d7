// SPDX-License-Identifier: Apache-2.0
// Which effects are tried, and where in their shapes a search for them begins.
#pragma once

#include <vector>

#include "diagnosis/scan.h"

namespace dcnn {

/// Members to try next to the model of a scan: every fit of the catalogue, every axis it admits,
/// every seed of its shapes; seeds of orders and frequencies come from what the model leaves. What
/// needs a test of its own (events, impacts, rounding, clipping) and what the log lacks the signals
/// for is left out.
std::vector<Member> candidates(const Scan& scan, const Signals& left,
                               const std::vector<Floor>& floors);

/// Laws of one strength that follow logged signals, without a lag at first: these plain ones, at
/// their shapes, and forms that are for such laws alone. None where no signal is logged.
std::vector<Member> driven_candidates(const Case& study, const std::vector<Member>& plain);

/// What the seeds of a law's speeds and lengths are multiplied by: they are those of a translation,
/// and a rotation has larger numbers (rad instead of m).
double seed_scale(const std::string& axis);

/// Whether the effect is in the catalogue of the case: of a tool, or of an axis of another machine.
bool is_listed(const Case& study, const EffectKind& kind);
/// The axes it can act on there; one empty name where it takes none.
std::vector<std::string> axes_of(const Case& study, const EffectKind& kind);

/// Whether the recordings hold the signals that the effect needs; if not, why, in words.
bool is_testable(const Case& study, const EffectKind& kind, std::string* why = nullptr);

/// Whether the axis' base simulator has this law, with a coefficient that is fitted: a spring with
/// another rest is then an offset.
bool is_in_base(const Case& study, const EffectKind& kind);

/// A constant offset beside them, where it is listed and none of them is one.
void add_constant(const Case& study, std::vector<Member>& members);

/// Members that are the simulator's own numbers.
std::vector<Member> own_parameters(const Case& study);

}  // namespace dcnn
