// SPDX-License-Identifier: Apache-2.0
// Whether a model that was found may be believed: what it leaves, how constant its members are, how
// well their numbers are known, and what could stand in their place.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/priors.h"
#include "diagnosis/joint_fit.h"

namespace dcnn {

/// What is left in one band of frequencies, against the floor.
struct BandTest {
  double from_hz, to_hz;
  double z;          ///< (sum - dof)/sqrt(2 dof) of the whitened periodogram
  double excess;     ///< sum - dof
  double dof = 0.0;  ///< 0: too few blocks follow each other for a periodogram

  bool stands_out() const { return z > prior::kBandStandsOut; }
  /// Power over what the floor makes.
  double loudness() const { return excess > 0.0 ? 1.0 + 2.0 * z * z / excess : 1.0; }
};
/// The bands that are tested, by how fast the motion is.
std::vector<BandTest> bands_of(const Case& study);
/// The floor comes from another band, so nothing has to be simulated for it.
std::vector<BandTest> band_tests(const Setting& setting, const Eigen::VectorXd& residual);

/// The greatest loudness of a band that stands out; 1 where none does.
double loudest(const std::vector<BandTest>& bands);
/// Their excess in all.
double left_over(const std::vector<BandTest>& bands);

/// Something is left that no member explains: above 5 deviations in a band, more than a remainder
/// of what was explained, and more than `least` of chi-square.
bool is_alarming(const std::vector<BandTest>& bands, double explained, double least = 0.0);

/// (rows, 12): the residual shifted circularly in time, within each run of consecutive rows, by
/// thirteenths of the run: surrogates of its spectrum that have nothing to do with the columns.
Eigen::MatrixXd shifted_in_time(const Setting& setting, const Eigen::VectorXd& residual);
/// Overdispersion of scores that surrogates make: over their degrees of freedom, at least 1. The
/// lower quartile, for a periodic motion is at some shifts where it was.
double overdispersion(std::vector<double> scores, double freedom);

/// Whether a member explains the recordings throughout: its score over blocks of 8 s, per degree of
/// freedom. A surrogate of something else fits some blocks and not others.
struct Constancy {
  double ratio = 1.0, z = 0.0, excess = 0.0;  ///< score over its degrees of freedom, and beyond
  double overdispersion = 1.0;                ///< of the scores of the residual shifted in time
  bool refutes() const { return ratio > prior::kInconstantRatio && z > prior::kInconstant; }
  /// z where what is left is so many times as loud as the noise.
  double above(double loud) const { return z * (ratio / loud - 1.0) / (ratio - 1.0); }
};
std::vector<Constancy> constancy(const Setting& setting, const JointFit& fit);

/// Rows of a whitened vector in blocks of time, all channels together.
std::vector<std::vector<Index>> time_blocks(const Setting& setting, double seconds);
/// The inverse of a Gram matrix, with a ridge that only decides what the data leave open.
Eigen::MatrixXd normal_inverse(const Eigen::MatrixXd& gram);

/// A published number with its 95 % interval.
struct Estimate {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;
};
/// Of all members, in their order: the larger of the model's and the sandwich's deviation over
/// blocks of 1 s, widened for the selection. What is searched for on a logarithmic scale has its
/// interval there, and so has a strength that hangs on such a number: likelihoods of time
/// constants and frequencies are far from symmetric where the data hardly hold them.
std::vector<std::vector<Estimate>> estimates(const Setting& setting, const JointFit& fit);

/// Sign-flip p value of one member with all others in the model: block scores keep their size and
/// lose their sign if it is nothing but noise of any colour.
double flip_p_value(const Setting& setting, const JointFit& fit, std::size_t member);
/// Below which no law falls in that test, however constant: 2^(1 - blocks), of all signs alike.
double least_flip_p_value(const Setting& setting);

/// First column of a member in the tangent, and how many it has.
std::pair<Index, Index> tangent_columns(const JointFit& fit, std::size_t member);

}  // namespace dcnn
