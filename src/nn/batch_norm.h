#pragma once

namespace dcnn {

constexpr double kBatchNormEpsilon = 1e-5;  // spec 2.4

}  // namespace dcnn
