#include "dcnn/import/log.h"

#include <cmath>

namespace dcnn {

void LogChannel::add(double value, bool keep) {
  if (keep) values.push_back(value);
  if (!std::isfinite(value)) return;
  if (finite > 0) largest_step = std::max(largest_step, std::abs(value - last));
  last = value;
  ++finite;
  low = std::min(low, value);
  high = std::max(high, value);
  whole = whole && value == std::floor(value);
}

Index LogStream::find(const std::string& channel) const {
  for (std::size_t k = 0; k < channels.size(); ++k) {
    if (channels[k].name == channel) return static_cast<Index>(k);
  }
  return -1;
}

}  // namespace dcnn
