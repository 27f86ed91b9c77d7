// SPDX-License-Identifier: Apache-2.0
#include "experiment/peers/epochs.h"

#include <algorithm>
#include <chrono>

#include "dcnn/nn/peak.h"
#include "experiment/peers/measure.h"
#include "experiment/peers/training.h"

namespace dcnn {

EpochRow compare_epochs(Child& child, const std::string& peer, const std::string& network,
                        int epochs) {
  const auto now = std::chrono::steady_clock::now;
  const Task task = named_task(network);
  EpochRow row{.network = network, .peer = peer, .threads = threads()};
  child.ask("task " + network + " " + std::to_string(row.threads));
  Training training(task);
  std::vector<double> ours, theirs, ratios;
  double peak = 0.0;
  for (int k = 0; k < epochs; ++k) {
    peak = std::max(peak, peak_multiply_adds(4));
    const auto begin = now();
    training.epoch();
    ours.push_back(std::chrono::duration<double>(now() - begin).count());
    theirs.push_back(child.ask("epoch")["seconds"].get<double>());
    ratios.push_back(theirs.back() / ours.back());
  }
  row.ours = median_of(ours);
  row.theirs = median_of(theirs);
  row.ratio = median_of(ratios);
  const double work = task.training_products * static_cast<double>(task.batches() * task.batch);
  row.share_of_peak = work / *std::ranges::min_element(ours) / peak;
  return row;
}

}  // namespace dcnn
