// SPDX-License-Identifier: Apache-2.0
// Training epochs, ours and another library's in turns.
#pragma once

#include <string>

#include "dcnn/experiment/peers.h"
#include "experiment/peers/child.h"

namespace dcnn {

/// So many epochs of each of the training of this name (training.h), on all threads.
EpochRow compare_epochs(Child& child, const std::string& peer, const std::string& network,
                        int epochs);

}  // namespace dcnn
