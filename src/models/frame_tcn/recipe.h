// SPDX-License-Identifier: Apache-2.0
// How frame-tcn learns: filters in closed form, gates by Adam, head by ridge, gates and head by
// Adam.
#pragma once

#include <vector>

#include "models/frame_tcn/adam.h"
#include "models/frame_tcn/material.h"
#include "models/frame_tcn/model.h"

namespace dcnn::frame_tcn {

/// Bins of 5 dB from -5 dB on, of each kind of noise; one more is clean.
constexpr Index kLevelBins = 16;
/// Every so manyth row of the copies at other speeds is kept.
constexpr Index kCopyStride = 4;

class StartMoments;

class Recipe {
 public:
  Recipe(FrameTcn& model, const Samples& training, const Samples& validation, FitSession& session);
  /// False when the session wanted to stop; a resumed one repeats what no checkpoint holds.
  bool run();

 private:
  /// A column of the batch: where it comes from.
  struct Draw {
    std::size_t source = 0;  ///< which material
    Index row = 0;
    int noise = -1;  ///< which unit noise, -1 clean
    double snr = 0.0, factor = 0.0;
  };
  struct Batch {
    Pass pass;
    std::vector<Draw> draws;
    Eigen::MatrixXd clean;  ///< (15, n)
  };

  void scale_channels();
  void make_noise();
  void make_filters();
  void make_expert(Index group, Index expert, std::size_t history, const Moments& signal,
                   const Eigen::MatrixXd& unit, double snr);
  void start_dense(Index group, const Eigen::MatrixXd& filter);
  std::array<Moments, 3> axis_moments(Index first_group) const;
  Moments pooled_moments(const std::array<Moments, 3>& axes, Index group) const;
  StartMoments start_moments() const;
  Moments young_moments(const StartMoments& starts, Index group, std::size_t history,
                        const Moments& old) const;
  Eigen::VectorXd feature_noise_power(Index group) const;
  Eigen::VectorXd reached_by_pose_noise() const;
  void make_material();
  void scale_levels();

  Draw draw(Rng& rng, bool copies) const;
  Batch batch(Rng& rng, Index size, bool copies) const;
  void fill(Batch& batch) const;
  double wanted_error(const Draw& draw, Index channel) const;
  bool on_pose(const Draw& draw) const;
  std::size_t bin(const Draw& draw) const;
  Eigen::VectorXd weights(const Batch& batch) const;
  Eigen::MatrixXd targets(const Batch& batch) const;

  Index ridge_batches() const;
  void begin_head();
  void measure_units();
  void solve_head(bool weighted);
  void measure_bins();
  double gate_step(Index step);
  double head_step(Index step);
  bool run_epoch();
  void finish_epoch(double loss);
  std::vector<Draw> noise_cases(double width) const;
  void calibrate_novelty();
  Batch in_order(std::size_t source, Draw draw) const;
  void calibrate_pace();
  Eigen::MatrixXd signs_at(const Eigen::MatrixXd& x, const std::vector<Segment>& segments,
                           Index first, const UnitNoise* noise, double snr) const;
  void save_checkpoint() const;
  void restore_checkpoint(const Container& file);

  FrameTcn& model_;
  const Spec& spec_;
  const Samples &training_, &validation_;
  FitSession& session_;
  Eigen::MatrixXd x_;  // normalised
  std::vector<UnitNoise> noise_;
  std::vector<Eigen::MatrixXf> noise_experts_, noise_roughness_, noise_cross_;
  std::vector<Material> material_;  // the training itself, then copies at other speeds
  Eigen::MatrixXd errors_;          // (experts, 15) expected squared error, each at its own level
  Eigen::VectorXd bins_;            // residual rms by level of noise
  Adam adam_;
  Index epoch_ = 0;
  double x_low_ = 0, x_high_ = 0, pose_low_ = 0, pose_high_ = 0, clean_share_ = 0.15;
};

}  // namespace dcnn::frame_tcn
