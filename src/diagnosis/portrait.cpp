#include "diagnosis/portrait.h"

#include <algorithm>
#include <cmath>

#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr std::size_t kPoints = 1500;  // in one picture

struct Abscissa {
  Eigen::VectorXd x;
  Eigen::MatrixXd direction;  // (T,3), or no rows: by channel
  std::string label;
};

/// What the law of a member is a function of, in one recording.
std::optional<Abscissa> coordinate_of(const Member& member, const Motion& motion) {
  if (motion.is_static()) return std::nullopt;
  if (member.kind->axis == AxisRule::kLine) {
    const bool turns = member.axis.starts_with("w_");
    return Abscissa{velocity_of(member.axis, motion), direction_of(member.axis, motion),
                    turns ? "angular velocity [rad/s]" : "velocity along the axis [m/s]"};
  }
  if (member.kind->axis == AxisRule::kAngle) {
    const AngleAxis at = angle_axis(member.axis);
    return Abscissa{motion.euler.col(at.angle), direction_of(at.axis, motion),
                    "angle " + member.axis.substr(0, member.axis.find(':')) + " [rad]"};
  }
  if (member.kind->stage == Stage::kOffset || member.interval_s) {
    return Abscissa{motion.t, {}, "time [s]"};
  }
  return std::nullopt;
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

}  // namespace

std::vector<Portrait> portraits(const Search& search) {
  const Case& study = search.study();
  const auto& members = search.fit().members;
  std::vector<Portrait> list;
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (!members[m].law.is_null()) continue;  // a picture of its own
    std::vector<Member> others = members;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
    const Chain rest(study, others);
    const Signals with = rest.with(members[m]), left = difference(study, rest.prediction());
    Portrait portrait;
    for (std::size_t k = 0; k < study.logs.size(); ++k) {
      const auto c = coordinate_of(members[m], study.logs[k].motion);
      if (!c) break;
      const Eigen::MatrixXd law = with[k] - rest.prediction()[k];
      const Index channel = strongest_channel(law);
      portrait.title = members[m].name();
      portrait.x_label = c->label;
      portrait.y_label = c->direction.rows() > 0
                             ? "force along the axis [N]"
                             : study.targets[static_cast<std::size_t>(channel)] + " [" +
                                   study.units[static_cast<std::size_t>(channel)] + "]";
      // Means over 20 ms: what is left is mostly noise sample by sample.
      const Index n = std::max<Index>(1, std::llround(0.02 / study.dt()));
      const Index blocks = law.rows() / n;
      const Index every = std::max<Index>(
          1, blocks * static_cast<Index>(study.logs.size()) / static_cast<Index>(kPoints));
      for (Index b = 0; b < blocks; b += every) {
        double sum = 0.0;
        for (Index i = b * n; i < (b + 1) * n; ++i) sum += along(study, *c, left[k], i, channel);
        const Index middle = b * n + n / 2;
        portrait.x.push_back(c->x(middle));
        portrait.left.push_back(sum / static_cast<double>(n));
        portrait.law.push_back(along(study, *c, law, middle, channel));
      }
    }
    if (!portrait.x.empty()) list.push_back(std::move(portrait));
  }
  return list;
}

}  // namespace dcnn
