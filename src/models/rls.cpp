// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "models/linear_model.h"
#include "models/recursive_least_squares.h"

namespace dcnn {
namespace {

const LinearModel::Form kRecursive{"regression", Terms::kRigid};

/// The terms of the rigid tool learned online, sample by sample (the scheme of arXiv 2604.23696):
/// one pass over the training rows in time. What it predicts on other recordings is the state at
/// the end of training, frozen, so that it is scored as the others are.
class Rls : public LinearModel {
 public:
  Rls(const Problem& problem, double forgetting)
      : LinearModel("rls", kRecursive, problem), forgetting_(forgetting) {}

 protected:
  void learn(const Samples& training) override {
    constexpr double kLeastRidge = 1e-12;
    const LeastSquares sums = sums_of(training);
    const Eigen::VectorXd size =
        group_sizes(sums.column_rms(), regressors().groups()).unaryExpr([](double s) {
          return s > 0.0 ? s : 1.0;
        });
    const double ridge = std::max(kLeastRidge, known_before(sums).mean());
    RecursiveLeastSquares filter(regressors().count(), training.y.cols(), forgetting_, ridge);
    for (Index i = 0; i < training.rows(); ++i) {
      const Eigen::VectorXd terms = regressors().of(training.x.row(i)).transpose();
      filter.update(terms.cwiseQuotient(size), training.y.row(i).transpose());
    }
    set_weights(size.cwiseInverse().asDiagonal() * filter.solve());
  }

 private:
  double forgetting_;
};

Json preset_rls(const std::string& name, bool /*axes*/) {
  Json json = closed_form_preset(name);
  json["model"] = {{"forgetting", 0.9999}};
  return json;
}

std::unique_ptr<Model> make_rls(const Problem& problem) {
  Options options(problem.configuration, problem.where, Exit::kUsage);
  Options model = options.child("model");
  const double forgetting = model.number("forgetting", 0.9999, 0.9, 1.0);
  model.raw("name");
  model.finish();
  return std::make_unique<Rls>(problem, forgetting);
}

std::unique_ptr<Model> load_rls(const Container& file, const std::string& where) {
  return std::make_unique<LinearModel>(file, std::vector{kRecursive}, where);
}

}  // namespace

extern const ModelKind rls_model;
const ModelKind rls_model{"rls", "the rigid tool's terms by recursive least squares, online",
                          preset_rls, make_rls, load_rls};

}  // namespace dcnn
