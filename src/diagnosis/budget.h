// SPDX-License-Identifier: Apache-2.0
// Of what kind of physics a difference is made, before any law is named.
#pragma once

#include "dcnn/core/json.h"
#include "diagnosis/search.h"

namespace dcnn {

/// Shares of the energy of what the simulator as given leaves (whitened, so that newtons and
/// newton-metres weigh alike), each beside those before it: what its own numbers explain
/// (`parameter`), functions of rates and angles as they are (`state`), of where the motion came
/// from
/// (`memory`), of the time (`clock`), pushes in the stretches of `segments` (`event`), `noise`, and
/// `other`. A share counts what is explained on blocks of time to which nothing was fitted; `z` is
/// its distance from zero in standard deviations over blocks. Empty for poses at rest.
Json budget(const Setting& setting, const Signals& left, const std::vector<Member>& own,
            const Json& segments);

}  // namespace dcnn
