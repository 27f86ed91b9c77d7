// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/portrait.h"

#include <algorithm>
#include <cmath>

#include "dcnn/physics/law.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr std::size_t kPoints = 1500;  // in one picture

struct Abscissa {
  Eigen::VectorXd x;
  Eigen::MatrixXd direction;  // (T,3), or no rows: by channel
  std::string label;
};

/// The coordinates of a law without a name, each once, and its axis where it has one.
std::vector<Abscissa> coordinates_of_law(const Case& study, const Member& member, const Log& log) {
  Options told(member.law, "law", Exit::kData), numbers(member.law_parameters, "law", Exit::kData);
  const law::Law of = law::parse_law(law::parse_structure(told), numbers);
  law::Terms terms = law::tool_terms();
  if (study.axis) {
    const Axis& axis = study.axis->axis();
    terms = law::axis_terms(axis.name, axis.unit, axis.position_unit, study.axis->sense);
  }
  terms = law::with_signals(terms, of.structure.signals);
  const bool has_scale = *law::directions()[of.structure.direction].unit != 0;
  const law::Vector3d own = law::own_vector(of.structure, of.numbers.data() + 1 + has_scale);
  const Index rows = log.motion.samples();
  Eigen::MatrixXd load = rigid_wrench(study.simulator.model, log.motion).force;
  if (log.base.force.rows() == rows) load += log.base.force;
  std::vector<std::size_t> seen;
  std::vector<Abscissa> list;
  for (const law::Factor& factor : of.structure.factors) {
    if (std::count(seen.begin(), seen.end(), factor.coordinate) > 0) continue;
    seen.push_back(factor.coordinate);
    const law::Coordinate& q = terms.coordinates[factor.coordinate];
    Abscissa c{Eigen::VectorXd(rows), Eigen::MatrixXd::Zero(rows, 3),
               q.words + (q.unit.empty() ? "" : " [" + q.unit + "]")};
    for (Index k = 0; k < rows; ++k) {
      const law::Sample now = law::sample_of(log.motion, k, load.row(k), of.structure.signals);
      const law::Vector3d n = law::direction_at(of.structure.direction, now, own);
      c.x(k) = law::coordinate_at(factor.coordinate, now, n, own);
      c.direction.row(k) = n.transpose();
    }
    if (!law::is_axis(of.structure.direction) || study.axis) c.direction.resize(0, 0);
    list.push_back(std::move(c));
  }
  return list;
}

/// What the law of a member is a function of, in one recording.
std::vector<Abscissa> coordinates_of(const Case& study, const Member& member, const Log& log) {
  const Motion& motion = log.motion;
  if (motion.is_static()) return {};
  if (!member.law.is_null()) return coordinates_of_law(study, member, log);
  if (member.kind->axis == AxisRule::kLine) {
    const bool turns = member.axis.starts_with("w_");
    return {{velocity_of(member.axis, motion), direction_of(member.axis, motion),
             turns ? "angular velocity [rad/s]" : "velocity along the axis [m/s]"}};
  }
  if (member.kind->axis == AxisRule::kAngle) {
    const AngleAxis at = angle_axis(member.axis);
    return {{motion.euler.col(at.angle), direction_of(at.axis, motion),
             "angle " + member.axis.substr(0, member.axis.find(':')) + " [rad]"}};
  }
  if (member.kind->stage == Stage::kOffset || member.interval_s) {
    return {{motion.t, {}, "time [s]"}};
  }
  return {};
}

/// The component of a signal along the direction, or in one channel.
double along(const Case& study, const Abscissa& c, const Eigen::MatrixXd& signal, Index row,
             Index channel) {
  if (c.direction.rows() == 0) return signal(row, channel);
  double sum = 0.0;
  for (std::size_t j = 0; j < study.channels.size(); ++j) {
    if (study.channels[j] < 3) {
      sum += c.direction(row, study.channels[j]) * signal(row, static_cast<Index>(j));
    }
  }
  return sum;
}

Index strongest_channel(const Eigen::MatrixXd& signal) {
  Index channel = 0;
  signal.colwise().squaredNorm().maxCoeff(&channel);
  return channel;
}

/// Means over 20 ms of one recording: what is left is mostly noise sample by sample.
void add_points(const Case& study, const Member& member, const Abscissa& c,
                const Eigen::MatrixXd& left, const Eigen::MatrixXd& law, Portrait& portrait) {
  const Index channel = strongest_channel(law);
  const auto at = static_cast<std::size_t>(channel);
  portrait.title = member.name();
  portrait.x_label = c.label;
  portrait.y_label = c.direction.rows() > 0 ? "force along the axis [N]"
                                            : study.targets[at] + " [" + study.units[at] + "]";
  const Index n = std::max<Index>(1, std::llround(0.02 / study.dt()));
  const Index blocks = law.rows() / n;
  const Index every = std::max<Index>(
      1, blocks * static_cast<Index>(study.logs.size()) / static_cast<Index>(kPoints));
  for (Index b = 0; b < blocks; b += every) {
    double sum = 0.0;
    for (Index i = b * n; i < (b + 1) * n; ++i) sum += along(study, c, left, i, channel);
    const Index middle = b * n + n / 2;
    portrait.x.push_back(c.x(middle));
    portrait.left.push_back(sum / static_cast<double>(n));
    portrait.law.push_back(along(study, c, law, middle, channel));
  }
}

}  // namespace

std::vector<Portrait> portraits(const Search& search) {
  const Case& study = search.study();
  const auto& members = search.fit().members;
  std::vector<Portrait> list;
  for (std::size_t m = 0; m < members.size(); ++m) {
    std::vector<Member> others = members;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
    const Chain rest(study, others);
    const Signals with = rest.with(members[m]), left = difference(study, rest.prediction());
    std::vector<Portrait> pictures;  // by coordinate
    for (std::size_t k = 0; k < study.logs.size(); ++k) {
      const auto coordinates = coordinates_of(study, members[m], study.logs[k]);
      const Eigen::MatrixXd law = with[k] - rest.prediction()[k];
      pictures.resize(std::max(pictures.size(), coordinates.size()));
      for (std::size_t i = 0; i < coordinates.size(); ++i) {
        add_points(study, members[m], coordinates[i], left[k], law, pictures[i]);
      }
    }
    std::erase_if(pictures, [](const Portrait& picture) { return picture.x.empty(); });
    list.insert(list.end(), pictures.begin(), pictures.end());
  }
  return list;
}

}  // namespace dcnn
