// SPDX-License-Identifier: Apache-2.0
#include "models/linear_model.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "dcnn/data/line_filter.h"
#include "models/least_squares.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kStandardGravity = 9.81;  // m/s^2
constexpr Index kLongestFilter = 1 << 16;
constexpr Index kRowsAtATime = 2048;  // terms in memory that does not grow with the recording

LinearModel::Form find_form(const Container& file, const std::vector<LinearModel::Form>& forms,
                            const std::string& where) {
  const std::string& name = stored_text(file, "form", where);
  for (const auto& form : forms) {
    if (form.name == name) return form;
  }
  fail(Exit::kModel, where, ": its kind of model has no form '", name, "'");
}

FeatureLayout stored_layout(const Container& file, const std::string& where) {
  return parse_layout(parse_json(stored_text(file, "features", where), where, Exit::kModel), where,
                      Exit::kModel);
}

bool begins_with_force(const Problem& problem) {
  const auto& names = problem.targets.names;
  const std::vector<std::string> force{"fx", "fy", "fz"};
  return !problem.is_remainder && problem.layout.system.kind == System::Kind::kWrist &&
         names.size() >= 3 && std::equal(force.begin(), force.end(), names.begin());
}

/// Calls use(first, terms) for pieces of the rows.
template <class Use>
void for_terms(const Regressors& regressors, const Eigen::MatrixXd& x, const Use& use) {
  for (Index first = 0; first < x.rows(); first += kRowsAtATime) {
    const Index n = std::min(kRowsAtATime, x.rows() - first);
    use(first, regressors.of(x.middleRows(first, n)));
  }
}

}  // namespace

LinearModel::LinearModel(std::string kind, Form form, const Problem& problem)
    : ClosedFormModel(std::move(kind), problem),
      form_(std::move(form)),
      layout_(problem.layout),
      regressors_(make_regressors(layout_, form_.terms)),
      weights_(Eigen::MatrixXd::Zero(regressors_->count(), problem.outputs())),
      is_force_(begins_with_force(problem)) {}

LinearModel::LinearModel(const Container& file, const std::vector<Form>& forms,
                         const std::string& where)
    : ClosedFormModel(file, where),
      form_(find_form(file, forms, where)),
      layout_(stored_layout(file, where)),
      regressors_(make_regressors(layout_, form_.terms)) {
  require(map().features() == static_cast<Index>(layout_.names.size()), Exit::kModel, where,
          ": its statistics have another number of rows than its features");
  const auto& values = stored_values<double>(file, "weights", where);
  const auto& shape = file.find("weights")->shape;
  require(shape.size() == 2 && shape[0] == regressors_->count() && shape[1] >= 1, Exit::kModel,
          where, ": its weights do not fit its terms");
  weights_ = Eigen::Map<const RowMajor>(values.data(), shape[0], shape[1]);
  if (!file.find("filter")) return;
  const auto& filter = stored_values<std::int64_t>(file, "filter", where);
  require(filter.size() == 1 && filter[0] > 1 && filter[0] <= kLongestFilter, Exit::kModel, where,
          ": its time filter is malformed");
  filter_ = filter[0];
}

Eigen::MatrixXd LinearModel::predict(const Stream& stream) const {
  Eigen::MatrixXd result(stream.rows(), weights_.cols());
  for_terms(*regressors_, filtered(stream), [&](Index first, const Eigen::MatrixXd& terms) {
    // One row at a time in the same order whatever the number of rows: the same bits.
    result.middleRows(first, terms.rows()) = terms.lazyProduct(weights_);
  });
  return result;
}

Eigen::MatrixXd LinearModel::filtered(const Stream& stream) const {
  if (filter_ <= 1) return stream.x;
  return line_filtered(stream.x, stream.segment_begins(), filter_);
}

void LinearModel::learn(const Samples& training) {
  set_weights(solve(sums_of(training), regressors_->groups(), form_.ridge));
}

LeastSquares LinearModel::sums_of(const Samples& training) const {
  LeastSquares sums(regressors_->count(), training.y.cols());
  for_terms(*regressors_, filtered(training), [&](Index first, const Eigen::MatrixXd& terms) {
    sums.add(terms, training.y.middleRows(first, terms.rows()));
  });
  return sums;
}

void LinearModel::save(Container& file) const {
  ClosedFormModel::save(file);
  file.metadata["form"] = form_.name;
  file.metadata["features"] = to_json(layout_).dump();
  if (filter_ > 1) file.tensors.push_back({"filter", {1}, std::vector<std::int64_t>{filter_}});
  const RowMajor rows = weights_;
  file.tensors.push_back({"weights",
                          {weights_.rows(), weights_.cols()},
                          std::vector<double>(rows.data(), rows.data() + rows.size())});
}

/// At rest F = A·u + bias with A = -m·9.81·R for any mounting R, so det A has the sign of -m. The
/// determinant must be a fair share of the largest that the size of A admits: a motion that does
/// not turn the tool about two axes leaves it undetermined.
double LinearModel::gravity_mass() const {
  constexpr double kDetermined = 0.1;
  if (!is_force_ || form_.terms == Terms::kFourier) return 0.0;
  const Eigen::Matrix3d A = weights_.topLeftCorner<3, 3>().transpose();
  const double size = A.norm() / std::sqrt(3.0);
  const double determinant = A.determinant();
  if (std::abs(determinant) < kDetermined * size * size * size) return 0.0;
  return -std::cbrt(determinant) / kStandardGravity;
}

std::vector<std::string> LinearModel::notes() const {
  const double mass = gravity_mass();
  if (mass >= 0.0) return {};
  return {negative_mass_note(mass)};
}

std::string LinearModel::negative_mass_note(double mass) {
  char text[160];
  std::snprintf(text, sizeof text,
                "the fitted mass is negative (%.3f kg): if the log holds the reaction, the force "
                "of the sensor on the tool, read it with --force-sign -1",
                mass);
  return text;
}

}  // namespace dcnn
