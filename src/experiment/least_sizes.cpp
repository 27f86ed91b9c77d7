// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/least_sizes.h"

#include <algorithm>
#include <cmath>

#include "dcnn/core/file.h"

namespace dcnn {
namespace {

/// Rows that sizes are computed on: half a minute at 500 Hz shows a motion.
constexpr Index kMostRows = 15000;

/// What an amplitude of one stands for: the published parameters of the catalogue's example with
/// the other amplitudes at zero.
struct UnitSize {
  std::string parameter;
  Json parameters;
};

/// The amplitudes of a kind: those parameters of its example that grow with an amplitude.
std::vector<UnitSize> unit_sizes(const EffectKind& kind) {
  const EffectFit& fit = kind.fits.front();
  Eigen::VectorXd shapes(static_cast<Index>(fit.shapes.size()));
  for (std::size_t k = 0; k < fit.shapes.size(); ++k) {
    const auto& seeds = fit.shapes[k].seeds;
    shapes(static_cast<Index>(k)) = seeds.empty() ? NAN : seeds[seeds.size() / 2];
  }
  std::vector<UnitSize> sizes;
  if (!fit.parameters || !shapes.allFinite()) return sizes;
  if (fit.amplitudes == 0 && fit.shapes.size() == 1) {  // a delay or a lag is its own size
    const Json only = fit.parameters(Eigen::VectorXd(0), shapes);
    for (const auto& [name, value] : only.items()) sizes.push_back({name, only});
    return sizes;
  }
  constexpr double kSmall = 1e-3;  // small enough for every law to be linear in it
  for (int i = 0; i < fit.amplitudes; ++i) {
    const Eigen::VectorXd unit = kSmall * Eigen::VectorXd::Unit(fit.amplitudes, i);
    const Json zero = fit.parameters(Eigen::VectorXd::Zero(fit.amplitudes), shapes);
    const Json one = fit.parameters(unit, shapes);
    for (const auto& [name, value] : one.items()) {
      if (value.is_number() && value.get<double>() != zero[name].get<double>()) {
        sizes.push_back({name, one});
        break;
      }
    }
  }
  return sizes;
}

/// Root mean square of the channel that an effect changes most.
double most_changed(const Wrench& with, const Wrench& without, bool torque) {
  const auto rms = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return std::sqrt((a - b).colwise().squaredNorm().maxCoeff() / static_cast<double>(a.rows()));
  };
  const double force = rms(with.force, without.force);
  const bool both = torque && with.torque.rows() > 0 && without.torque.rows() > 0;
  return both ? std::max(force, rms(with.torque, without.torque)) : force;
}

Recording first_rows(const std::filesystem::path& path, ReadOptions read) {
  read.static_list = true;  // as the diagnosis reads it
  Recording recording = read_recording(path, read, System());
  if (recording.samples() > kMostRows) {
    recording.table.values.conservativeResize(kMostRows, Eigen::NoChange);
    std::erase_if(recording.segments, [](const Segment& s) { return s.begin >= kMostRows; });
    if (!recording.segments.empty()) {
      recording.segments.back().end = std::min(recording.segments.back().end, kMostRows);
    }
  }
  return recording;
}

class LeastSizes {
 public:
  LeastSizes(Simulator simulator, const Recording& recording, bool torque)
      : simulator_(std::move(simulator)),
        motion_(motion_of(recording, simulator_, DerivativeSpec())),
        without_(simulate(simulator_, motion_)),
        torque_(torque) {}

  /// The largest over the axes of the smallest size that adds `rms`; null where there is none.
  Json of(const EffectKind& kind, double rms) const {
    Json largest;
    auto axes = admitted_axes(kind.axis);
    if (axes.empty()) axes.emplace_back();
    for (const auto& axis : axes) {
      const Json least = along(kind, axis, rms);
      if (least.is_null()) continue;
      if (largest.is_null() || least["value"].get<double>() > largest["value"].get<double>()) {
        largest = least;
      }
    }
    return largest;
  }

 private:
  Json along(const EffectKind& kind, const std::string& axis, double rms) const {
    Json least;
    double most = 0.0;  // of the amplitude that shows most
    for (const UnitSize& size : unit_sizes(kind)) {
      Simulator changed = simulator_;
      changed.effects.push_back({kind.name, axis, std::nullopt, size.parameters, ""});
      const double seen = most_changed(simulate(changed, motion_), without_, torque_);
      if (!(seen > most)) continue;
      most = seen;
      const double unit = std::abs(size.parameters[size.parameter].get<double>());
      least = {{"parameter", size.parameter},
               {"value", unit * rms / seen},
               {"unit", unit_of_parameter(size.parameter)}};
    }
    return least;
  }

  Simulator simulator_;
  Motion motion_;
  Wrench without_;
  bool torque_;
};

}  // namespace

void add_least_sizes(const DiagnosisRequest& request, Diagnosis& diagnosis) {
  if (!request.simulator || request.fit.empty()) return;
  const auto& targets = diagnosis.report["targets"];
  const LeastSizes sizes(diagnosis.corrected, first_rows(request.fit.front(), request.read),
                         targets.size() > 3);
  Json& list = diagnosis.report["not_detected"];
  for (std::size_t k = 0; k < list.size(); ++k) {
    const EffectKind* kind = find_effect(list[k]["effect"].get<std::string>());
    if (!kind || kind->fits.empty()) continue;
    try {
      const Json least = sizes.of(*kind, list[k]["minimum_detectable_rms"].get<double>());
      if (!least.is_null()) list[k]["least"] = least;
    } catch (const Error&) {
      continue;  // parameters of the seeds that the law refuses: the rms stays
    }
  }
}

}  // namespace dcnn
