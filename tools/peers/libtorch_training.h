// SPDX-License-Identifier: Apache-2.0
// Training epochs of src/experiment/peers/training.h with libtorch.
#pragma once

#include <memory>
#include <string>

#include "peers/serve.h"

namespace dcnn::peers {

/// The training of this name on random data of its size.
std::unique_ptr<Trainee> make_trainee(const std::string& network);

}  // namespace dcnn::peers
