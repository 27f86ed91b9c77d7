// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/identifier.h"

#include <array>

#include "models/tensor_io.h"
#include "models/weighted_model.h"

namespace dcnn {
namespace {

constexpr const char* kFormat = "dcnn-identifier";
constexpr const char* kFormatVersion = "1";

Json parse_text(const Container& file, const std::string& key, const std::string& where) {
  return parse_json(stored_text(file, key, where), where, Exit::kModel);
}

Targets parse_targets(const Json& json, const std::string& where) {
  try {
    Targets targets{json.at("names").get<std::vector<std::string>>(),
                    json.at("units").get<std::vector<std::string>>()};
    require(!targets.names.empty() && targets.names.size() == targets.units.size(), Exit::kModel,
            where, ": its list of targets is malformed");
    return targets;
  } catch (const Json::exception&) {
    fail(Exit::kModel, where, ": its list of targets is malformed");
  }
}

/// The kind of model that a file names.
const ModelKind& stored_kind(const std::string& name, const std::string& where) {
  try {
    return model_kind(name, Exit::kModel);
  } catch (const Error& error) {
    fail(error.exit(), where, ": ", error.what());
  }
}

/// The wrench's column of a target, by the names of contract section 2.
Eigen::VectorXd wrench_column(const Wrench& wrench, const std::string& target) {
  constexpr std::array<const char*, 3> kForce{"fx", "fy", "fz"}, kTorque{"tx", "ty", "tz"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    if (target == kForce[i]) return wrench.force.col(column);
    if (target == kTorque[i] && wrench.torque.rows() > 0) return wrench.torque.col(column);
  }
  fail(Exit::kData, "the base simulator does not predict '", target,
       "'; give it an inertia for torques, or leave --base out");
}

/// The simulator's own estimator where it names one, unless the model must run online.
DerivativeSpec base_derivative(const Identifier& identifier) {
  const DerivativeSpec& own = identifier.layout.spec.derivative;
  const bool online = own.kind == DerivativeSpec::Kind::kCausalSavitzkyGolay;
  return online ? own : identifier.base->derivative.value_or(own);
}

}  // namespace

Eigen::MatrixXd Identifier::base_prediction(const Recording& recording) const {
  const auto count = static_cast<Eigen::Index>(targets.names.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(recording.samples(), count);
  if (!base) return result;
  Simulator own = *base;
  own.derivative = base_derivative(*this);
  const Motion motion = motion_of(recording, own, *own.derivative);
  const Wrench wrench = simulate(*base, motion, nullptr, nullptr);
  for (Eigen::Index j = 0; j < count; ++j) {
    result.col(j) = wrench_column(wrench, targets.names[static_cast<std::size_t>(j)]);
  }
  return result;
}

Eigen::MatrixXd Identifier::predict(const Recording& recording) const {
  return model->predict({make_features(recording, layout).x, recording.segments}) +
         base_prediction(recording);
}

Eigen::VectorXd Identifier::novelty(const Recording& recording) const {
  return model->novelty({make_features(recording, layout).x, recording.segments});
}

Container pack(const Identifier& identifier) {
  Container file;
  file.metadata["format"] = kFormat;
  file.metadata["format_version"] = kFormatVersion;
  file.metadata["features"] = to_json(identifier.layout).dump();
  file.metadata["targets"] =
      Json{{"names", identifier.targets.names}, {"units", identifier.targets.units}}.dump();
  file.metadata["configuration"] = identifier.configuration.dump();
  file.metadata["seed"] = std::to_string(identifier.seed);
  if (identifier.base) file.metadata["base"] = to_json(*identifier.base).dump();
  if (identifier.online) file.metadata["online"] = to_json(*identifier.online).dump();
  identifier.model->save(file);
  return file;
}

Identifier unpack(const Container& file, const std::string& where) {
  require(stored_text(file, "format", where) == kFormat, Exit::kModel, where,
          ": not a model of this program; give a file written by dcnn-train");
  require(stored_text(file, "format_version", where) == kFormatVersion, Exit::kModel, where,
          ": format version ", stored_text(file, "format_version", where), ", this program reads ",
          kFormatVersion, "; train again or use the program that wrote it");
  Identifier identifier;
  identifier.name = stored_text(file, "model", where);
  identifier.layout = parse_layout(parse_text(file, "features", where), where, Exit::kModel);
  identifier.targets = parse_targets(parse_text(file, "targets", where), where);
  identifier.configuration = parse_text(file, "configuration", where);
  identifier.seed = std::strtoull(stored_text(file, "seed", where).c_str(), nullptr, 10);
  if (file.metadata.count("base")) {
    identifier.base = parse_simulator(parse_text(file, "base", where), where, Exit::kModel);
  }
  identifier.model = stored_kind(identifier.name, where).load(file, where);
  require(identifier.model->map().features() == static_cast<Index>(identifier.layout.names.size()),
          Exit::kModel, where, ": its model has another number of rows than its features");
  if (file.metadata.count("online")) {
    identifier.online = parse_limits(parse_text(file, "online", where), where);
    require(identifier.online->envelope.features() == identifier.model->map().features(),
            Exit::kModel, where, ": its envelope has another number of rows than its features");
  }
  const Eigen::MatrixXd probe =
      identifier.model->predict({identifier.model->map().mean().transpose(), {}});
  require(probe.cols() == static_cast<Index>(identifier.targets.names.size()), Exit::kModel, where,
          ": its model has another number of outputs than its targets");
  identifier.model = with_stored_weights(std::move(identifier.model), probe.cols(), file, where);
  return identifier;
}

Identifier read_identifier(const std::filesystem::path& path, Precision precision) {
  Identifier identifier = unpack(read_container(path), path.string());
  try {
    if (precision != Precision::kSingle) identifier.model->set_precision(precision);
  } catch (const Error& error) {
    fail(error.exit(), path.string(), ": ", error.what());
  }
  return identifier;
}

}  // namespace dcnn
