// SPDX-License-Identifier: Apache-2.0
#include "models/linear_model.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace {

class NsPredictor final : public Predictor {
 public:
  explicit NsPredictor(Index outputs) : zero_(Eigen::VectorXd::Zero(outputs)) {}
  void reset() noexcept override {}
  const Eigen::VectorXd& push(const Eigen::VectorXd& /*x*/) noexcept override { return zero_; }

 private:
  Eigen::VectorXd zero_;
};

/// No identification: what every other model is measured by.
class Ns : public ClosedFormModel {
 public:
  explicit Ns(const Problem& problem)
      : ClosedFormModel("ns", problem), outputs_(problem.outputs()) {
    Options options(problem.configuration, problem.where, Exit::kUsage);
    Options model = options.child("model");
    model.raw("name");
    model.finish();
  }
  Ns(const Container& file, const std::string& where) : ClosedFormModel(file, where) {
    const auto& outputs = stored_values<std::int64_t>(file, "outputs", where);
    require(outputs.size() == 1 && outputs[0] >= 1 && outputs[0] <= kMostOutputs, Exit::kModel,
            where, ": its number of targets is out of range");
    outputs_ = outputs[0];
  }

  Eigen::MatrixXd predict(const Stream& stream) const override {
    return Eigen::MatrixXd::Zero(stream.rows(), outputs_);
  }
  std::unique_ptr<Predictor> predictor() const override {
    return std::make_unique<NsPredictor>(outputs_);
  }
  Index parameter_count() const override { return 0; }
  void save(Container& file) const override {
    ClosedFormModel::save(file);
    file.tensors.push_back({"outputs", {1}, std::vector<std::int64_t>{outputs_}});
  }

 protected:
  void learn(const Samples& /*training*/) override {}

 private:
  static constexpr Index kMostOutputs = 10'000;
  Index outputs_ = 0;
};

Json preset_ns(const std::string& name, bool /*axes*/) { return closed_form_preset(name); }

std::unique_ptr<Model> make_ns(const Problem& problem) { return std::make_unique<Ns>(problem); }

std::unique_ptr<Model> load_ns(const Container& file, const std::string& where) {
  return std::make_unique<Ns>(file, where);
}

}  // namespace

extern const ModelKind ns_model;
const ModelKind ns_model{"ns", "no identification: predicts zero", preset_ns, make_ns, load_ns,
                         true};

}  // namespace dcnn
