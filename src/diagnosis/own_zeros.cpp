// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/own_zeros.h"

#include <algorithm>

#include "diagnosis/words.h"

namespace dcnn {
namespace {

/// How far the means of what is left in each recording lie apart, in the unit of the channel, where
/// that is most beside its noise.
struct Apart {
  std::size_t channel = 0;
  double distance = 0.0, share = 0.0;  // the latter of the noise of one sample
};

Apart zeros_apart(const Search& search) {
  Apart most;
  for (std::size_t j = 0; j < search.floors().size(); ++j) {
    double low = kInfinity, high = -kInfinity;
    for (const Eigen::MatrixXd& left : search.left()) {
      const double mean = left.col(static_cast<Index>(j)).mean();
      low = std::min(low, mean);
      high = std::max(high, mean);
    }
    const double share = (high - low) / search.floors()[j].deviation();
    if (share > most.share) most = {j, high - low, share};
  }
  return most;
}

}  // namespace

/// Whether zeros that differ between the recordings, each less than the noise of one sample, are
/// all that is left: a warm sensor, or a motor that was switched on anew.
bool Search::admit_own_zeros() {
  const bool own = std::any_of(study_.logs.begin(), study_.logs.end(),
                               [](const Log& log) { return log.zeroed; });
  if (own || study_.zeros_differ || study_.logs.size() < 2 || study_.is_static()) return false;
  if (zeros_apart(*this).share > 1.0) return false;
  const std::vector<Member> members = fit_.members;
  for (Case* study : cases()) study->zeros_differ = true;
  settle(members);
  if (noise_suffices()) return true;
  for (Case* study : cases()) study->zeros_differ = false;
  settle(members);
  is_alarming_now();
  return false;
}

std::optional<std::string> note_of_zeros(const Search& search) {
  const Case& study = search.study();
  if (!study.zeros_differ) return std::nullopt;
  const Apart most = zeros_apart(search);
  return "the zero of " + study.targets[most.channel] +
         " is another one in each recording, by up to " + brief(most.distance) + " " +
         study.units[most.channel] + ", " + brief(100.0 * most.share) +
         " % of its noise: it decides nothing";
}

}  // namespace dcnn
