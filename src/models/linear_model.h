// SPDX-License-Identifier: Apache-2.0
// Identifiers that are linear in known terms: force = weights^T · terms of the motion.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dcnn/models/model.h"
#include "models/least_squares.h"
#include "models/regressors.h"

namespace dcnn {

/// What all fits without iterations have in common: the noise of training, the statistics of the
/// features, one report to the session.
class ClosedFormModel : public Model {
 public:
  bool fit(const Samples& training, const Samples& validation, FitSession& session) override;
  const InputMap& map() const override { return map_; }
  void save(Container& file) const override;

 protected:
  /// Reads the sections map, training and noise, of which training may hold `validation` alone.
  ClosedFormModel(std::string kind, const Problem& problem);
  /// From a file, of which metadata "model" names the kind.
  ClosedFormModel(const Container& file, const std::string& where);
  /// Learns from the samples, noise included.
  virtual void learn(const Samples& training) = 0;
  /// The training rows are not all clean.
  bool is_noisy() const;

 private:
  std::string kind_;
  std::vector<std::string> units_;
  InputMap::Spec map_spec_;
  InputMap map_;
  NoiseSpec noise_;
  std::uint64_t seed_ = 0;
};

/// Least squares on the terms, or any other way of finding the weights.
class LinearModel : public ClosedFormModel {
 public:
  struct Form {
    std::string name;  ///< model.form
    Terms terms;
    double ridge = 0.0;  ///< on the mean square of the scaled terms
  };
  LinearModel(std::string kind, Form form, const Problem& problem);
  /// `forms`: those of the kind, one of which the file must name.
  LinearModel(const Container& file, const std::vector<Form>& forms, const std::string& where);

  /// From here on the features pass a causal line filter over so many samples (line_filter.h)
  /// before anything is made from them: the time filter that DCNN-T has, for the same comparison.
  void filter_over(Index samples) { filter_ = samples; }

  Eigen::MatrixXd predict(const Stream& stream) const override;
  std::unique_ptr<Predictor> predictor() const override;
  Index parameter_count() const override { return weights_.size(); }
  void save(Container& file) const override;
  /// Says so when the fitted mass is negative.
  std::vector<std::string> notes() const override;

 protected:
  void learn(const Samples& training) override;

  /// The training rows as a problem in the terms.
  LeastSquares sums_of(const Samples& training) const;
  const Form& form() const { return form_; }
  const FeatureLayout& layout() const { return layout_; }
  const Regressors& regressors() const { return *regressors_; }
  const Eigen::MatrixXd& weights() const { return weights_; }
  void set_weights(Eigen::MatrixXd weights) { weights_ = std::move(weights); }
  static std::string negative_mass_note(double mass);

 private:
  /// kg, whatever the sensor's mounting; 0 where the terms or the motion do not tell it.
  double gravity_mass() const;
  Eigen::MatrixXd filtered(const Stream& stream) const;

  Form form_;
  FeatureLayout layout_;
  std::shared_ptr<const Regressors> regressors_;
  Eigen::MatrixXd weights_;  // (terms, targets)
  Index filter_ = 1;         // samples; 1 is none
  bool is_force_ = false;    // the targets begin with the whole force on the sensor
};

/// Preset of a model without iterations: the same everywhere, but `paper` trains on all rows.
Json closed_form_preset(const std::string& preset);

}  // namespace dcnn
