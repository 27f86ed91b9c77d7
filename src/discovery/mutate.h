// SPDX-License-Identifier: Apache-2.0
// From the best of the dictionary to the law itself: changes of its form, each fitted.
#pragma once

#include "discovery/refine.h"

namespace dcnn::discovery {

/// The forms that were fitted, the best score first: the given ones, and changes of the best of
/// them for as long as these gain.
std::vector<Trial> evolved(const Data& data, std::vector<Trial> trials);

/// Its shapes as tables, with more nodes and with fewer, and with a factor fewer, for as long as
/// that gains.
Sketch with_finer_curves(const Data& data, const Sketch& from);

/// The forms of fewer numbers that a sketch has when a part of it is left out, and those without
/// the constant beside a much larger factor; numbers as they were.
std::vector<Sketch> plainer(const Data& data, const Sketch& from);

}  // namespace dcnn::discovery
