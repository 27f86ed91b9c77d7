// SPDX-License-Identifier: Apache-2.0
#include "experiment/train_physics.h"

#include <cmath>

#include "dcnn/core/file.h"
#include "dcnn/core/interruptible.h"
#include "dcnn/data/csv.h"
#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/identification/identify.h"
#include "experiment/splitter.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

/// A model that is its simulator alone: what it adds is zero.
TrainingRequest as_simulator(TrainingRequest request) {
  request.configuration.model = "ns";
  request.configuration.epochs.reset();  // has none
  return request;
}

/// The training rows of each recording, in SI units, as recordings of their own.
void write_training_rows(const TrainingRequest& request, const fs::path& folder,
                         DiagnosisRequest& wanted) {
  const double share = request.validation.empty() ? resolve(request.configuration).validation : 0.0;
  for (std::size_t k = 0; k < request.training.size(); ++k) {
    const Recording recording = read_recording(request.training[k], request.read, System());
    const fs::path file = folder / ("train_" + std::to_string(k) + ".csv");
    Table head = recording.table;
    head.values = recording.table.values.topRows(training_rows(recording, share));
    write_csv(file, head);
    wanted.fit.push_back(file);
    if (recording.zeroed) wanted.zeroed.push_back(file);
  }
}

TrainingOutcome corrected_tool(const TrainingRequest& request, const fs::path& folder,
                               const TrainingObserver& observer) {
  fs::create_directories(folder);
  TrainingRequest corrected = as_simulator(request);
  DiagnosisRequest wanted;
  write_training_rows(corrected, folder, wanted);
  wanted.simulator = request.base;
  if (!wanted.simulator) {
    const ToolIdentification tool = identify_tool({wanted.fit, {}, std::nullopt});
    wanted.simulator = folder / "sim.json";
    write_file(*wanted.simulator, to_json(Simulator{tool.model, {}}).dump(2) + "\n");
  }
  const Diagnosis diagnosis = diagnose(wanted, observer.note);
  if (observer.note) observer.note(headline(diagnosis.report));
  corrected.base = folder / "model.json";
  write_file(*corrected.base, diagnosis.model.dump(2) + "\n");
  return train(corrected, observer);
}

}  // namespace

bool can_be_physics(const TrainingRequest& request) {
  return !request.configuration.online &&
         resolve(as_simulator(request).configuration).system.kind == System::Kind::kWrist;
}

TrainingOutcome train_physics(const TrainingRequest& request, const fs::path& folder,
                              const TrainingObserver& observer) {
  const Interruptible scope(observer.stop_wanted);
  try {
    return corrected_tool(request, folder, observer);
  } catch (const Interrupted&) {  // a diagnosis has no state: --resume begins it anew
    return {false, {{"run_directory", request.out.parent_path().string()}}};
  }
}

}  // namespace dcnn
