// SPDX-License-Identifier: Apache-2.0
// What a preset does: models, training protocols, noise modes, draws, timing.
#pragma once

#include <string>
#include <vector>

#include "dcnn/data/noise.h"
#include "dcnn/experiment/evaluate.h"
#include "dcnn/experiment/reproduce.h"
#include "experiment/reproduction/entries.h"

namespace dcnn {

/// How the models of one series were trained.
struct Protocol {
  std::string name;   ///< A or B
  std::string words;  ///< for the report
  Json noise;         ///< configuration of the training noise
};

/// One way to put noise on the test inputs.
struct NoiseMode {
  std::string name;   ///< part of file names
  std::string words;  ///< for the report
  std::vector<std::string> protocols;
  int draws = 20;
  Index every = 1;  ///< every so manyth test sample is scored
};

struct TimingPlan {
  int repetitions = 10, repetitions_lstm_25 = 1;
  Index samples = 32045;
};

struct ReproductionPlan {
  std::vector<Entry> entries;  ///< NS first
  std::vector<Protocol> protocols;
  std::vector<NoiseMode> modes;
  TimingPlan timing;
  int trainings = 0;  ///< further seeds
  std::vector<SnrLevel> levels{std::nullopt, 40.0, 30.0, 20.0, 10.0};
};

ReproductionPlan make_plan(const ReproductionRequest& request);

/// How much longer than in preset `standard` the training of an entry takes.
double training_factor(const std::string& preset, const Entry& entry);

}  // namespace dcnn
