// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <iostream>

#include "dcnn/core/file.h"
#include "dcnn/core/standard_input.h"
#include "dcnn/models/onnx.h"
#include "dcnn/physics/axis_machine.h"
#include "support/file_kind.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-predict model.dcnn --data log.csv --out predicted.csv\n"
    "  dcnn-predict model.dcnn --onnx model.onnx\n"
    "  dcnn-predict diagnosis/model.json --data log.csv --out predicted.csv   # a corrected "
    "simulator\n";

Recording predict_with_model(const std::filesystem::path& model, const std::filesystem::path& data,
                             ReadOptions read, Precision precision) {
  const Identifier identifier = read_identifier(model, precision);
  read.static_list = identifier.layout.dt == 0.0;  // it was learned from poses at rest
  Recording recording = read_recording(data, read, identifier.layout.system);
  const Eigen::MatrixXd predicted = identifier.predict(recording);
  for (std::size_t j = 0; j < identifier.targets.names.size(); ++j) {
    recording.set(identifier.targets.names[j] + "_hat",
                  predicted.col(static_cast<Eigen::Index>(j)));
  }
  const Eigen::VectorXd novelty = identifier.novelty(recording);
  if (novelty.size() > 0) {
    recording.set("novelty", novelty);
    const auto beyond = (novelty.array() > 1.0).count();
    if (beyond > recording.samples() / 100) {  // as rare as the threshold allows is no news
      recording.notes.push_back(std::to_string(beyond) + " of " +
                                std::to_string(recording.samples()) +
                                " rows move unlike the training (column 'novelty' above 1): their "
                                "errors may be of any size; train on such motion, too");
    }
  }
  return recording;
}

Recording predict_with_machine(const AxisMachine& machine, const std::filesystem::path& data,
                               const ReadOptions& read) {
  Recording recording = read_recording(data, read, machine.system);
  const Eigen::MatrixXd predicted = predict_axes(machine, recording);
  for (std::size_t k = 0; k < machine.system.axes.size(); ++k) {
    recording.set(machine.system.axes[k].measured + "_hat",
                  predicted.col(static_cast<Eigen::Index>(k)));
  }
  return recording;
}

Recording predict_with_simulator(const std::filesystem::path& model,
                                 const std::filesystem::path& data, ReadOptions read) {
  read.static_list = true;
  if (const Json json = read_json(model, Exit::kData); is_axis_machine(json)) {
    return predict_with_machine(parse_axis_machine(json, model.string(), Exit::kModel), data, read);
  }
  const Simulator simulator = read_simulator(model);
  Recording recording = read_recording(data, read, System());
  const Recording predicted = predict_motion(simulator, recording, DerivativeSpec());
  for (const char* target : {"fx", "fy", "fz", "tx", "ty", "tz"}) {
    if (predicted.has(target))
      recording.set(std::string(target) + "_hat", predicted.column(target));
  }
  return recording;
}

/// A simulator is JSON by its name or, on standard input, by its first byte.
bool is_simulator(const std::filesystem::path& model) {
  if (model != "-") return model.extension() == ".json";
  constexpr std::size_t kBlanks = 1024;
  char byte = ' ';
  for (std::size_t k = 0; k < kBlanks && std::isspace(static_cast<unsigned char>(byte)) != 0; ++k) {
    if (read_standard_input(k, &byte, 1, Exit::kModel) == 0) break;
  }
  return byte == '{';
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-predict", "Predicts the tool's force for every row of a recording.", kExamples);
  std::filesystem::path model;
  std::optional<std::filesystem::path> data, out, onnx;
  tool.option("model", model, "model file (.dcnn), or a simulator (.json)")
      .required()
      .holds({FileKind::kModel, FileKind::kSimulator, FileKind::kMachine, FileKind::kSystem});
  tool.option("--data", data, "recording").holds({FileKind::kRecording});
  tool.output(
      "--out", out,
      "CSV to write: the input columns, <target>_hat, and novelty from models that measure it");
  tool.output("--onnx", onnx,
              "write the model as ONNX: features in SI units to targets in theirs, for other "
              "runtimes");
  const PrecisionFlag precision(tool);
  const ReadFlags read(tool);

  tool.check([&] {
    if (onnx) expect_kind("--onnx", model, {FileKind::kModel});
  });
  tool.shares_work();

  return tool.run(argc, argv, [&] {
    require(data.has_value() == out.has_value() && (data || onnx), Exit::kUsage,
            "give --data and --out to predict, --onnx to export, or all three");
    if (onnx) write_file(*onnx, to_onnx(read_identifier(model)));
    if (!data) {
      if (tool.common().json) Tool::print({{"onnx", onnx->string()}});
      return Exit::kDone;
    }
    ReadOptions options = read.options();
    options.motion_only = true;
    const bool simulator = is_simulator(model);
    require(!simulator || precision.value() == Precision::kSingle, Exit::kUsage,
            "--precision int16 is for a trained model; ", model.string(), " is a simulator");
    const Recording recording = simulator
                                    ? predict_with_simulator(model, *data, options)
                                    : predict_with_model(model, *data, options, precision.value());
    for (const auto& note : recording.notes) tool.note(note);
    write_csv(*out, recording.table);
    if (*out == "-") return Exit::kDone;  // standard output holds the rows
    const Json summary = {{"rows", recording.samples()}, {"file", out->string()}};
    if (tool.common().json) {
      Tool::print(summary);
    } else {
      std::cout << out->string() << ": " << recording.samples() << " rows\n";
    }
    return Exit::kDone;
  });
}
