// SPDX-License-Identifier: Apache-2.0
// A force law as data: a product of shapes of named coordinates along a direction, with units.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "dcnn/physics/effect.h"
#include "dcnn/physics/first_order.h"

namespace dcnn::law {

using Eigen::Vector3d;

/// A scalar of the motion or of the force that the law is added to.
struct Coordinate {
  std::string name;       ///< "v_tool_z"
  std::string unit;       ///< "m/s"
  std::string frame;      ///< base, sensor, tool, or "" for what no frame changes
  std::string words;      ///< "the velocity along the tool"
  bool is_rate = false;   ///< a displacement per second: states of displacement integrate it
  bool is_clock = false;  ///< of the recording's clock: not known online
};
/// All of them; a law names one by its place in this list.
const std::vector<Coordinate>& coordinates();
/// Taken along the law's own direction, or from its point: none without one.
bool is_own(std::size_t coordinate);
/// A column of the recordings, which a structure names; "signal_1" … stand for them in files.
constexpr std::size_t kMostSignals = 3;
bool is_signal(std::size_t coordinate);
std::size_t signal_coordinate(std::size_t signal);
/// What the axis of a machine has: angle alpha, what moves along base x, sizes, time.
bool is_of_axes(std::size_t coordinate);

/// A vector of the sensor frame that the force is proportional to.
struct Direction {
  const char* name;   ///< "base_x", "velocity"
  const char* unit;   ///< empty for unit vectors, else of the vector, which is divided by a scale
  const char* words;  ///< "the base's x axis"
};
const std::vector<Direction>& directions();
/// That of a machine's drive.
std::size_t drive_direction();
/// An axis of sensor, tool or base.
bool is_axis(std::size_t direction);
/// An axis, or a vector product with one: it may be oblique.
bool has_axis(std::size_t direction);
/// Away from a point of the base frame, whose place are numbers of the law.
bool is_central(std::size_t direction);

/// What is called how in which unit: by default that of a tool.
struct Terms {
  std::vector<Coordinate> coordinates;  ///< in the places of coordinates(); no name: not there
  std::string axis;                     ///< of a machine, "joint2"; else empty
  std::string force = "N";              ///< unit of the amplitude, not on torques
  double resisting = -1.0;              ///< sign of an amplitude that resists the motion
};
const Terms& tool_terms();
/// Of the axis of a machine whose effort has unit `effort`; `resisting` is 1 where the drive's
/// effort is told, which overcomes friction, and -1 where the reaction to it is.
Terms axis_terms(const std::string& axis, const std::string& effort,
                 const std::string& position_unit, double resisting);
/// The same with these columns as signals, which have no unit that is known.
Terms with_signals(Terms terms, const std::vector<std::string>& columns);

/// f(u), u = (q - centre)/scale, q the coordinate or a state that it drives; p a further number. A
/// curve has neither: it goes through values at even distances from u = -1 to 1.
struct Shape {
  const char* name;
  const char* equation;            ///< in u and p
  const char* latex;               ///< with @ for u and # for p
  const char* extra;               ///< stem of p, or empty
  double least = 0.0, most = 0.0;  ///< bounds of p
  bool free_scale = true;          ///< false: the amplitude does what the scale could, which stays
  bool free_centre = true;
  bool signed_scale = false;  ///< the two signs of the scale are two laws
  double (*value)(double u, double p) = nullptr;
  double told_at = 0.0;  ///< u at which words tell the law's size; 0: the amplitude itself is told
};
const std::vector<Shape>& shapes();
/// Of a factor whose shape is a table of values.
bool is_curve(std::size_t shape);
constexpr std::size_t kFewestNodes = 3, kMostNodes = 33;
/// Through `values` at u = -1 ... 1: cubic, with the slopes of neighbours (Catmull and Rom 1974);
/// constant outside.
double curve_at(const double* values, std::size_t count, double u);

/// What a coordinate drives before the shape.
enum class Memory {
  kNone,
  kLag,       ///< s' = (q - s)/tau
  kHighPass,  ///< q - s with that s
  kPlay,      ///< s follows q at the distance of a width (Krasnosel'skii and Pokrovskii 1989)
  kDahl,   ///< ds = (dx - abs(dx) s)/width, x the coordinate or, of a rate, its integral; |s| <= 1
  kStop,   ///< ds = dx while abs(s) < width: elastic, then it slips (Prandtl 1928); over the width
  kDwell,  ///< s' = 1 - abs(x') s/length: seconds of contact (Dieterich 1979)
  kSecondOrder,  ///< s'' = w^2 (q - s) - 2 d w s', w the natural frequency, d the damping ratio
  kDelay,        ///< q as it was so many seconds ago
  /// s' = (1 - s)/recovery - abs(x') s/length: 1 after a rest, broken down by motion (Moore 1959)
  kThixotropic,
  kLags,       ///< the mean of lags whose times are evenly spread on a log scale (Fung 1972)
  kPlays,      ///< the mean of plays whose widths are evenly spread up to a size (Iwan 1966)
  kUnevenLag,  ///< s' = (q - s)/tau, of one time where q is above s and another where it is below
};
/// Numbers of a state: a size, and the damping ratio of the second order, the time of recovery, the
/// ratio of the longest of many lags to the shortest, whose geometric mean is the size, or the time
/// in which an uneven lag falls.
int numbers_of(Memory memory);
/// Whether it follows what drives it, in that one's unit: a state of time alone.
bool is_of_time(Memory memory);
/// Of a state of second order: below 1, where two lags do the same.
constexpr double kLeastDamping = 0.005, kMostDamping = 0.98;
constexpr double kMostSpread = 1e6;  ///< of many lags

struct Factor {
  std::size_t shape = 0, coordinate = 0;  ///< places in shapes() and coordinates()
  Memory memory = Memory::kNone;
  bool centred = false;
  std::size_t nodes = 0;  ///< of a curve, the value of which at node `peak` is 1
  std::size_t peak = 0;
  bool remembered = false;  ///< a state of time is of f(u), not f of the state
  bool operator==(const Factor&) const = default;
};
/// Numbers of one factor: of its state, its centre, its scale, and those of its shape.
std::size_t numbers_of(const Factor& factor);

/// One number of a law, as published.
struct Number {
  std::string name, unit;
  /// Set once and not fitted: the amplitude is told at this value.
  bool is_reference = false;
  double low = 0.0, high = 0.0;  ///< bounds; positive where low > 0
};

/// force = amplitude · product of factors · direction, the product behind a lag where `lagged`, or
/// behind the mean of many where that is `spread`.
struct Structure {
  std::size_t direction = 0;
  bool direction_lagged = false;  ///< the vector passes a first-order lag
  /// Of the direction of motion: in the base frame it follows over a path, z' = v/L - abs(v) z/L
  /// (Dahl 1968, of vectors): a contact that gives way before it slides.
  bool presliding = false;
  bool lagged = false, spread = false;
  bool on_torque = false;
  std::vector<Factor> factors;
  bool oblique = false;  ///< the direction's axis e_k is e_k + a e_(k+1) + b e_(k+2), normalised
  std::vector<std::string> signals = {};  ///< columns that its factors take
  bool operator==(const Structure&) const = default;
};
/// Numbers of the direction itself: a and b of an oblique axis, or the point.
int own_numbers(const Structure& structure);
/// The unit axis in the frame that the direction names, or the point, m; `numbers` are those.
Vector3d own_vector(const Structure& structure, const double* numbers);

/// The numbers that a structure has, in the order in which a law holds them: the amplitude, those
/// of the direction (scale, own, lag), the lag, then factor by factor memory, centre, scale, p.
std::vector<Number> numbers_of(const Structure& structure, const Terms& terms = tool_terms());

struct Law {
  Structure structure;
  Eigen::VectorXd numbers;
};

/// The structure of a law as it stands in a file; expression, coordinates and the like are told
/// again by to_json() and not read.
Structure parse_structure(Options& options, const Terms& terms = tool_terms());
Law parse_law(const Structure& structure, Options& parameters, const Terms& terms = tool_terms());
/// {"axis", "factors", …, "expression", "latex", "words", "coordinates", "states"}.
Json to_json(const Law& law, const Terms& terms = tool_terms());
Json parameters_json(const Law& law, const Terms& terms = tool_terms());

std::string expression(const Law& law, const Terms& terms = tool_terms());
std::string latex(const Law& law, const Terms& terms = tool_terms());
/// "a force against the velocity along the tool, …".
std::string words(const Law& law, const Terms& terms = tool_terms());
bool needs_clock(const Structure& structure);
bool needs_position(const Structure& structure);

/// What coordinates and directions are made of, at one sample.
struct Sample {
  Eigen::Matrix3d R_BS = Eigen::Matrix3d::Identity();
  Vector3d euler, p_B, v_B, a_B, w_S, dw_S;
  Vector3d load_S;  ///< N, the force that the law is added to
  double t = 0.0;   ///< s, the recording's clock
  std::array<double, kMostSignals> signals{};
};
/// Of a row of a motion that has velocities; its place is 0 where it has none, and so are `signals`
/// that it has not.
Sample sample_of(const Motion& motion, Eigen::Index row, const Vector3d& load_S,
                 const std::vector<std::string>& signals);
/// Not of those that are the law's own.
double coordinate_at(std::size_t coordinate, const Sample& now);
/// The same of all, along the unit vector `n_S` or from the point `own`.
double coordinate_at(std::size_t coordinate, const Sample& now, const Vector3d& n_S,
                     const Vector3d& own);
/// In the sensor frame; unit vectors are zero where what they are taken from is. `own` is
/// own_vector().
Vector3d direction_at(std::size_t direction, const Sample& now, const Vector3d& own);

/// s' = (q - s)/tau of a value or a vector, exact for an input linear between samples.
template <class Value>
class LagRun {
 public:
  Value step(const Value& q, double tau, double h, bool first);
  const Value& value() const { return s_; }
  /// Goes on from there.
  void set(const Value& s) { s_ = s; }

 private:
  Value s_{}, before_{};
  double h_ = -1.0, decay_ = 0.0, ramp_ = 0.0;  // of the step before
};

/// The mean of lags whose times are evenly spread on a log scale over `spread` about `tau`.
class LagsRun {
 public:
  LagsRun(double tau, double spread);  ///< s, and longest over shortest; tau 0 for none
  double step(double q, double h, bool first);

 private:
  std::vector<double> times_;
  std::vector<LagRun<double>> lags_;
};

/// The direction of motion over a path, in the sensor frame as it turns; 0 where a stretch begins.
class PreslidingRun {
 public:
  Vector3d step(const Sample& now, double length, double h, bool first);

 private:
  Vector3d z_B_ = Vector3d::Zero();
};

/// A value as it was some time ago, linear between samples; of long delays a sample is kept every
/// 1/1000 of the delay.
class DelayRun {
 public:
  explicit DelayRun(double delay);  ///< s; 0 for none, which keeps nothing
  double step(double q, double h, bool first);

 private:
  struct Kept {
    double t, q;
  };
  const Kept& kept(std::size_t k) const { return ring_[(oldest_ + k) % ring_.size()]; }
  double delay_ = 0.0, now_ = 0.0;
  std::vector<Kept> ring_;
  std::size_t oldest_ = 0, count_ = 0;
};

/// The state that a factor's coordinate drives, and its value; step() allocates nothing.
class FactorRun {
 public:
  /// `numbers`: those of the state, the centre, the scale, and that of the shape, where there are.
  FactorRun(const Factor& factor, const double* numbers);
  /// `h` s after the sample before; `first` begins a stretch, states in equilibrium.
  double step(double q, double h, bool first);

 private:
  double state(double q, double h, bool first);
  double shaped(double q) const;
  double mean_of_plays(double q, bool first);
  const Shape* shape_;
  std::vector<double> curve_;  // values at its nodes
  Memory memory_;
  bool is_rate_, remembered_;
  double size_ = 1.0, second_ = 1.0, centre_ = 0.0, scale_ = 1.0, extra_ = 0.0;
  double s_ = 0.0, before_ = 0.0;
  LagRun<double> lag_, falling_;
  LagsRun lags_;
  DelayRun delay_;
  std::vector<double> plays_;
  // Of second order: the state is the imaginary part of x' = pole x + q, times a gain.
  std::complex<double> pole_, x_;
  double gain_ = 1.0;
  FirstOrder<std::complex<double>> swing_;
};

/// The force of a law sample by sample; step() allocates nothing.
class LawRun {
 public:
  explicit LawRun(const Law& law);
  Vector3d step(const Sample& now, double h, bool first);

 private:
  Structure structure_;
  double amplitude_ = 0.0, scale_ = 1.0, direction_tau_ = 0.0, length_ = 0.0, tau_ = 0.0;
  Vector3d own_;
  std::vector<FactorRun> factors_;
  LagRun<double> lag_;
  LagsRun lags_{0.0, 1.0};
  PreslidingRun presliding_;
  LagRun<Vector3d> direction_lag_;
};

}  // namespace dcnn::law
