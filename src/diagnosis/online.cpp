// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/online.h"

namespace dcnn {
namespace {

constexpr double kLongestWindow = 0.12, kShorter = 0.75;  // s; each window of the one before

/// Mean square of what a model leaves, each channel in units of its noise.
double squared_error(const Case& study, const std::vector<Member>& members,
                     const std::vector<Floor>& floors) {
  const Signals left = difference(study, predict(study, members));
  double sum = 0.0;
  for (Index j = 0; j < study.channel_count(); ++j) {
    const double s = floors[static_cast<std::size_t>(j)].deviation();
    sum += mean_square(study, left, j) / (s * s);
  }
  return sum;
}

}  // namespace

Case by_derivative(Case study, const DerivativeSpec& derivative) {
  set_derivative(study, derivative);
  return study;
}

std::optional<DerivativeSpec> best_online(const Search& search) {
  const Case& study = search.study();
  if (study.axis || !study.own_tool || study.is_static()) return std::nullopt;
  std::optional<DerivativeSpec> best;
  double least = kInfinity;
  for (const int order : {2, 3}) {
    DerivativeSpec spec = causal_derivative();
    spec.order = order;
    int before = 0;
    for (spec.window_s = kLongestWindow; spec.window(study.dt()) != before;
         spec.window_s *= kShorter) {
      before = spec.window(study.dt());
      const double error =
          squared_error(by_derivative(study, spec), search.fit().members, search.floors());
      if (error < least) least = error, best = spec;
    }
  }
  return best;
}

}  // namespace dcnn
