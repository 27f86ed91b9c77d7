// Scenarios with concealed effects: an independent world that shares no physics with the fitter.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn::conceal {

/// What is hidden: an id of vocabulary.md (or one that it lacks), in its units and names.
struct Hidden {
  std::string effect;
  std::string axis;  ///< empty for none
  std::optional<std::pair<double, double>> interval_s;
  std::map<std::string, double> parameters;
};

/// Rigid tool and gravity, SI, sensor frame.
struct Tool {
  double mass = 0.7;
  Eigen::Vector3d com{0.0, 0.0, 0.1}, bias{0.0, 0.0, 0.0};
};

/// Sensor noise [N]: `white`, `ar1`, `heteroscedastic`, `heavy` or `quantised` (0.5 mN lattice).
struct Noise {
  std::string kind = "white";
  double sigma = 0.04, pose_m = 1e-5, pose_rad = 1e-5;
};

struct Recorded {
  std::string name;
  bool holdout = false;
  Eigen::VectorXd t;
  Eigen::MatrixXd pose;             ///< (T, 6) as read: x,y,z [m], alpha,beta,gamma [rad]
  Eigen::MatrixXd measured, clean;  ///< (T, 3) [N]: as read, and without sensor noise
};

struct Scenario {
  std::string id, group;
  Tool tool;  ///< as the simulator at hand has it
  Noise noise;
  std::string motion;
  double amplitude = 0.0;  ///< of each effect, see draw()
  bool listed = true;      ///< all that is hidden has an id in vocabulary.md
  std::vector<Hidden> hidden;
  std::vector<Recorded> recordings;
};

/// Ids of vocabulary.md that a wrist force can show, and those beyond it.
const std::vector<std::string>& listed_effects();
const std::vector<std::string>& unlisted_effects();

/// Draws the scenario `id` = "group/effect/number" of a seed. Groups: `singles:A`, `unlisted:A`,
/// `poor:A` (A: amplitude; effect named), `doubles:A`, `triples:A` (effect `any`), `null:KIND`
/// (KIND of noise or `pose`), `parameters:A` (effect mass, com, gravity_tilt or bias). The
/// amplitude of an effect is the rms of what it alone changes on its strongest axis over the fit
/// recordings, divided by the sensor noise.
Scenario draw(const std::string& id, std::uint64_t seed);

/// Writes sim.json and one CSV per recording; returns the files to fit on and those held out.
struct Files {
  std::filesystem::path simulator;
  std::vector<std::filesystem::path> fit, holdout;
};
Files write(const Scenario& scenario, const std::filesystem::path& folder);

/// The answers, in the form of a report's findings.
Json truth(const Scenario& scenario);

}  // namespace dcnn::conceal
