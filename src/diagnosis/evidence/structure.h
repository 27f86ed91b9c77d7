// SPDX-License-Identifier: Apache-2.0
// The evidence of one structure: which effects act, with and without an unknown beside them.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/field.h"
#include "diagnosis/evidence/slow_noise.h"

namespace dcnn::evidence {

/// What the unknown is most likely a function of.
struct Unknown {
  double log_factor = -1e300;  ///< ln of its Bayes factor, prior of the choice of fields included
  double gain = 0.0;           ///< ln of the best field's Bayes factor
  std::vector<std::string>
      words;  ///< "velocity along sensor z, along sensor_z", most telling first
};

struct Structure {
  std::vector<Member> members;
  double chi2 = 0.0;
  double log_named = 0.0;  ///< ln p(recordings, members), up to a constant of the setting
  SlowNoise noise;         ///< beside them
  Unknown unknown;
};

/// Laplace's approximation at the best fit: with amplitudes whose whitened norm is log-uniform and
/// whose direction is uniform, shapes uniform on the scale they are searched on (their bounds),
/// ends of an interval uniform over the recordings, and the priors of priors.h for each name.
Structure structure_of(const Setting& setting, const Grid& grid, const JointFit& fit);
/// Structure::log_named alone: without an unknown, in a hundredth of the time.
double log_named_of(const Setting& setting, const Grid& grid, const JointFit& fit);

}  // namespace dcnn::evidence
