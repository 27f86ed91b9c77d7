// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/plan.h"

namespace dcnn {
namespace {

const char* const kFeatureWords = "white noise on each feature, its power relative to that feature";

/// The headline mode and the other readings of "Gaussian noise on the inputs".
std::vector<NoiseMode> noise_modes(const std::string& preset) {
  const bool quick = preset == "quick", paper = preset == "paper";
  const int draws = quick ? 2 : paper ? 20 : 5;
  const Index every = quick ? 8 : paper ? 1 : 4;
  return {
      {"feature", kFeatureWords, {"A", "B"}, quick ? 2 : 20, quick ? Index{8} : Index{1}},
      {"matlab",
       "one power over the whole matrix, as awgn(X, snr, 'measured')",
       {"A"},
       draws,
       every},
      {"pose", "noise on the logged pose, before it is differentiated", {"A"}, draws, every},
      {"entries",
       "a leak: noise on each of the five columns of X* by itself, for models on X* (DCNN, DCNN "
       "valid), where it averages out; on X for all others",
       {"A"},
       draws,
       every}};
}

}  // namespace

ReproductionPlan make_plan(const ReproductionRequest& request) {
  ReproductionPlan plan;
  plan.entries = choose_entries(request.models, request.preset);
  plan.protocols = {{"A", "trained with noise, fresh in every epoch", Json::object()},
                    {"B", "trained without noise", {{"levels_db", Json::array({nullptr})}}}};
  plan.modes = noise_modes(request.preset);
  if (request.draws) {
    for (NoiseMode& mode : plan.modes) mode.draws = *request.draws;
  }
  if (request.preset == "quick") plan.timing = {1, 1, 4000};
  if (request.preset == "paper") plan.timing.repetitions_lstm_25 = 10;
  plan.trainings = request.trainings;
  return plan;
}

double training_factor(const std::string& preset, const Entry& entry) {
  if (preset == "quick") return entry.kind.find("fnn") != std::string::npos ? 0.05 : 0.17;
  if (preset == "fair") return entry.kind == "dcnn" ? 5 : 2.5;
  if (preset == "paper") return entry.kind == "dcnn" ? 17 : 8;
  return 1;
}

}  // namespace dcnn
