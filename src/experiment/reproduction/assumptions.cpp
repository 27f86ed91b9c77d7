// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/assumptions.h"

namespace dcnn {
namespace {

constexpr const char *kFree = "free", *kInferred = "inferred",
                     *kDefault = "default of the toolbox the paper used";

std::vector<Assumption> of_the_data() {
  return {
      {"data", "the authors' recordings are not public",
       "simulated tool: 0.75 kg, mounting, cable, cross-talk, drift and noise of "
       "configs/sim/embedded.json",
       kFree},
      {"D4", "mean and spread over which data", "training recording, stored in the model",
       kInferred},
      {"D5", "15 dimensions with or without the position", "without (Eq. 2)", kInferred},
      {"D7", "how velocities and accelerations are estimated",
       "Savitzky-Golay, third order, 0.1 s, centred", kFree},
      {"D8", "Euler convention and wrapping", "Z-Y'-X'', unwrapped, on the branch of the training",
       kInferred},
      {"D9", "rate of the log", "500 Hz", kFree},
      {"D10", "split 41729/32045", "two recordings of different trajectories", kInferred},
      {"D30", "force range of the sensor", "sensor noise 0.04 N, no filter", kFree},
      {"mounting", "who knows how the sensor is mounted",
       "frame-tcn, to whose inputs rigid-body frames belong; no other", kFree},
  };
}

std::vector<Assumption> of_the_network() {
  return {
      {"D1", "feature maps 14x4 to 11x1, or 3x2400 weights",
       "'same' (3x2400); 'valid' in a row of its own", kInferred},
      {"D3", "sigma of Eq. 7 is called the variance", "standard deviation", kInferred},
      {"D11", "epochs of the DCNN", "500 / 60 / 30 / 5 for paper / fair / standard / quick", kFree},
      {"D12", "rate factor 0.001 after 300 epochs", "in preset paper; else 0.1 late", kFree},
      {"D15", "initial weights", "narrow normal in preset paper, Glorot else", kInferred},
      {"D16", "statistics of batch norm for prediction", "a full pass after training", kDefault},
      {"D28", "place and rate of dropout", "on the flattened maps, 0.5", kInferred},
      {"D29", "scale of the targets", "newtons in preset paper, standardised else", kFree},
      {"D37", "incomplete last batch", "skipped", kDefault},
      {"L2", "weight decay", "1e-4", kDefault},
  };
}

std::vector<Assumption> of_the_others() {
  return {
      {"D13", "learning rate 0.2 of the LSTM", "in preset paper; 0.005 else", kFree},
      {"D14", "sequence length of the LSTM", "1; 25 in a row of its own", kInferred},
      {"D25", "formula of CF", "gravity direction, 12 parameters", kInferred},
      {"D26", "inputs of the shallow networks", "15; the angles alone in rows of their own",
       kInferred},
      {"D27", "training of the shallow networks", "Levenberg-Marquardt, toolbox defaults",
       kDefault},
      {"D36", "their random 70/15/15 division leaks", "kept; contiguous blocks in preset fair",
       kDefault},
  };
}

std::vector<Assumption> of_the_experiment() {
  return {
      {"D2", "Eq. 5 divides by i", "by N, under the root", kInferred},
      {"D17", "the four noise levels are not named", "40, 30, 20, 10 dB, and clean", kFree},
      {"D18", "power of the noise", "per feature, variance; other modes beside", kFree},
      {"D19", "noise 'at each epoch'",
       "A: training and test; B: test only; and only the DCNN trained with it", kFree},
      {"D20", "'20 runs'", "20 draws of test noise, each model trained once", kInferred},
      {"D22", "NS", "prediction zero", kInferred},
      {"D23", "predictive length", "samples per call", kInferred},
      {"claims", "'on average' in the claims", "mean over the four noisy levels", kFree},
  };
}

}  // namespace

std::vector<Assumption> assumptions() {
  std::vector<Assumption> all;
  for (auto part : {of_the_data(), of_the_network(), of_the_others(), of_the_experiment()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace dcnn
