// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/base_errors.h"

#include "dcnn/data/filter.h"

namespace dcnn {

std::vector<Signals> base_errors(const Case& study) {
  std::vector<Signals> columns(static_cast<std::size_t>(study.logs.front().base_errors.cols()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    for (const Log& log : study.logs) {
      columns[k].push_back(low_pass(log.base_errors.col(static_cast<Index>(k)), log.motion.segments,
                                    log.motion.dt, study.lowpass_hz));
    }
  }
  return columns;
}

}  // namespace dcnn
