// SPDX-License-Identifier: Apache-2.0
// Steps of draw(): which effect, how strong, on which motion, read with which noise.
#pragma once

#include "conceal/world.h"

namespace dcnn::conceal {

/// " " separates the ids of `list`.
bool has(const std::string& list, const std::string& id);

template <class T>
T one_of(Rng& rng, const std::vector<T>& all) {
  return all[rng.below(all.size())];
}
double logarithmic(Rng& rng, double low, double high);

/// A group's share of a challenge, and what takes turns in it.
struct Share {
  std::string group;
  double part;
  std::vector<std::string> values, effects;
};
/// Every group by its share, its values and effects in turn, in a drawn order.
std::vector<std::string> plan_of(const std::vector<Share>& shares, int scenarios, Rng& rng);

std::string draw_axis(const std::string& id, Rng& rng);
std::map<std::string, double> draw_parameters(const std::string& id, const std::string& axis,
                                              Rng& rng);

/// Point masses about the tool's centre, and an offset of torque.
void draw_body(Tool& tool, Rng& rng);
/// The numbers that an effect has where torques are read: a lever, or torques beside its forces.
void draw_torques(Hidden& h, Rng& rng);

/// Whether an id is one of drawn_laws(), and the numbers of any of them.
bool is_drawn_law(const std::string& id);
std::map<std::string, double> draw_law(Rng& rng);

/// Neighbours that the data can tell apart; `same_axis` where they share it.
struct Neighbours {
  std::string first, second;
  bool same_axis;
};
const std::vector<Neighbours>& neighbours();
/// Whether two effects side by side are one and the same to any reader of the force.
bool confounded(const std::string& a, const std::string& b);

/// The effect whose strength follows the temperature in "driven_…"; else the id itself.
std::string undriven(const std::string& id);
/// Gives its strength a part that grows with the temperature, by 3 to 8 % of it for each kelvin.
void draw_drive(Hidden& h, Rng& rng);

/// The conditions of a family; those of `plain` draw nothing.
Conditions draw_conditions(const std::string& family, Rng& rng);
/// Adds the tremor to a pose (T, 6) at the world's rate.
void add_tremor(const Conditions& conditions, Eigen::MatrixXd& pose, Rng& rng);
/// Factors of the sensor's noise where it reads `force` (T, 3) [N], or (T, 6) with torques.
Eigen::MatrixXd noise_scale(const Conditions& conditions, const Eigen::MatrixXd& force, Rng& rng);
/// The rows that the log holds.
std::vector<Eigen::Index> kept_rows(const Conditions& conditions, Eigen::Index rows, Rng& rng);

/// Gives what acts for some time its interval, in the first recording.
void place(Hidden& h, const Scenario& s, const std::vector<Path>& paths, Rng& rng);

/// Scales `h` until it alone changes the fit recordings by `target` [N] on its strongest axis,
/// or as far as its parameters stay plausible. Its amplitude is what it has then. Nothing where it
/// changes nothing on these paths: friction along an axis that rests, a load that never slides.
std::optional<Hidden> of_amplitude(const std::vector<Path>& paths, const Scenario& s, Hidden h,
                                   double target);

/// Pauses between recordings, from the end of one to the start of the next [s].
double next_start(double end);
/// Fills one recording from its path.
void record(const Scenario& s, const Path& path, bool thermometer, Recorded& r, Rng& rng);
/// Fills s.recordings from the paths.
void record(Scenario& s, const std::vector<Path>& paths, bool thermometer, Rng& rng);

}  // namespace dcnn::conceal
