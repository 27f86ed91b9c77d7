// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

#include "models/inertial.h"
#include "models/linear_model.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace {

const LinearModel::Form kRegression{"regression", Terms::kRigid};
const LinearModel::Form kInertial{"inertial", Terms::kRigid};
const std::vector<std::string> kWrench{"fx", "fy", "fz", "tx", "ty", "tz"};

/// The ten inertial parameters and the bias: few enough to be physical, and right only where the
/// sensor's mounting and gain are known.
class InertialModel : public LinearModel {
 public:
  explicit InertialModel(const Problem& problem)
      : LinearModel("rigid", kInertial, problem), is_remainder_(problem.is_remainder) {}
  InertialModel(const Container& file, const std::string& where)
      : LinearModel(file, {kInertial}, where) {
    const auto& values = stored_values<double>(file, "inertial", where);
    require(values.size() == InertialParameters::RowsAtCompileTime, Exit::kModel, where,
            ": it does not hold 16 inertial parameters");
    fit_.parameters = Eigen::Map<const InertialParameters>(values.data());
    const std::string& active = stored_text(file, "constraint_active", where);
    require(active == "true" || active == "false", Exit::kModel, where,
            ": 'constraint_active' is neither true nor false");
    fit_.constraint_active = active == "true";
    require(layout().spec.set != FeatureSpec::Set::kAxes && weights().cols() == 6 &&
                weights().isApprox(rebuilt(), 1e-9),
            Exit::kModel, where, ": its weights are not those of its inertial parameters");
  }

  Index parameter_count() const override { return fit_.parameters.size(); }

  void save(Container& file) const override {
    LinearModel::save(file);
    file.metadata["constraint_active"] = fit_.constraint_active ? "true" : "false";
    const auto& p = fit_.parameters;
    file.tensors.push_back({"inertial", {p.size()}, std::vector<double>(p.begin(), p.end())});
  }

  std::vector<std::string> notes() const override {
    if (is_remainder_) return {};
    std::vector<std::string> result{description()};
    if (fit_.free_mass < 0.0) result.push_back(negative_mass_note(fit_.free_mass));
    if (fit_.constraint_active) {
      result.emplace_back(
          "least squares alone gave a body that cannot exist; the fit is held to a positive "
          "pseudo-inertia. A motion that turns about all axes tells the inertia better");
    }
    if (is_noisy()) {
      result.emplace_back(
          "training noise makes inertial parameters smaller than they are; for physical values "
          "set noise.levels_db to [null]");
    }
    return result;
  }

 protected:
  void learn(const Samples& training) override {
    fit_ = fit_inertial(sums_of(training), wrist_columns(layout()));
    set_weights(rebuilt());
  }

 private:
  Eigen::MatrixXd rebuilt() const {
    return inertial_weights(fit_.parameters, wrist_columns(layout()));
  }

  std::string description() const {
    const auto& p = fit_.parameters;
    const double m = p[0] > 0.0 ? p[0] : 1.0;
    char text[200];
    std::snprintf(text, sizeof text,
                  "mass %.4f kg, centre of mass (%.4f, %.4f, %.4f) m, inertia about the sensor "
                  "(%.5f, %.5f, %.5f) kg m^2",
                  p[0], p[1] / m, p[2] / m, p[3] / m, p[4], p[5], p[6]);
    return text;
  }

  InertialFit fit_;
  bool is_remainder_ = false;
};

Json preset_rigid(const std::string& name, bool /*axes*/) {
  Json json = closed_form_preset(name);
  json["model"] = {{"form", "regression"}};
  return json;
}

Index filter_samples(const Options& model, double seconds, double dt) {
  const double samples = dt > 0.0 ? std::round(seconds / dt) : 0.0;
  if (!(samples >= 2.0 && samples <= 65536.0)) {
    model.reject("filter_s", "must be 2 to 65536 samples of recordings with a clock");
  }
  return static_cast<Index>(samples);
}

std::unique_ptr<Model> make_rigid(const Problem& problem) {
  Options options(problem.configuration, problem.where, Exit::kUsage);
  Options model = options.child("model");
  const std::string form = model.choice("form", "regression", {"regression", "inertial"});
  const double filter_s = model.number("filter_s", 0.0, 0.0, 100.0);
  model.raw("name");
  model.finish();
  if (form == "regression") {
    auto rigid = std::make_unique<LinearModel>("rigid", kRegression, problem);
    if (filter_s > 0.0) rigid->filter_over(filter_samples(model, filter_s, problem.layout.dt));
    return rigid;
  }
  if (filter_s > 0.0) model.reject("filter_s", "is for model.form 'regression' alone");
  if (problem.targets.names != kWrench || problem.layout.system.kind != System::Kind::kWrist) {
    model.reject("form",
                 "is 'inertial', which needs the targets fx,fy,fz,tx,ty,tz of a wrist; "
                 "use 'regression'");
  }
  return std::make_unique<InertialModel>(problem);
}

std::unique_ptr<Model> load_rigid(const Container& file, const std::string& where) {
  if (stored_text(file, "form", where) == kInertial.name) {
    return std::make_unique<InertialModel>(file, where);
  }
  return std::make_unique<LinearModel>(file, std::vector{kRegression}, where);
}

}  // namespace

extern const ModelKind rigid_model;
const ModelKind rigid_model{
    "rigid",      "the rigid tool: regression on its terms, or its parameters",
    preset_rigid, make_rigid,
    load_rigid,   true};

}  // namespace dcnn
