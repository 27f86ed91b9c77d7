// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/pace.h"

#include <cstddef>
#include <numeric>

namespace dcnn {

double Pace::share(std::size_t stage, double done, double now) {
  for (; stage_ < stage; ++stage_) {  // the last report of a stage is its end
    if (last_ > began_) planned_done_ += planned_[stage_], spent_ += last_ - began_;
    began_ = last_;
  }
  last_ = now;
  const double planned = planned_[stage] * done, spent = now - began_;
  if (!(planned_done_ + planned > 0.0) || !(now > 0.0)) return 0.0;
  const double overall = (spent_ + spent) / (planned_done_ + planned);
  const double own = planned > 0.0 ? spent / planned : overall;
  const double after = std::accumulate(planned_.begin() + static_cast<std::ptrdiff_t>(stage) + 1,
                                       planned_.end(), 0.0);
  const double left = planned_[stage] * (1.0 - done) * own + after * overall;
  return now / (now + left);
}

}  // namespace dcnn
