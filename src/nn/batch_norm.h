// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace dcnn {

constexpr double kBatchNormEpsilon = 1e-5;  // added to the variance (Ioffe and Szegedy 2015)

}  // namespace dcnn
