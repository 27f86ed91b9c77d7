// SPDX-License-Identifier: Apache-2.0
// What may act beside the rigid tool, as columns of its regression.
#pragma once

#include "identification/wrist_model.h"

namespace dcnn::identification {

/// The laws that these logs can tell from nothing at all: friction by axis, cables as springs, a
/// base that is not level, sensor faults, a delay.
std::vector<Law> candidate_laws(const std::vector<WristLog>& logs, bool torque);

/// Shares of the velocity's deviation over which dry friction may turn; what is narrower changes no
/// force that a low-passed reading shows.
inline const std::vector<double> kTurnings{0.01, 0.02, 0.05, 0.1, 0.2, 0.5};

/// (n, channels·amplitudes) of log `k`: what a unit of each amplitude adds, linear in it about the
/// state.
Eigen::MatrixXd law_columns(const Law& law, const std::vector<WristLog>& logs, std::size_t k,
                            const WristColumns& columns, const WristState& state);

/// "dry friction of 0.42 N along the tool"
std::string law_words(const Law& law, const Eigen::VectorXd& amplitudes);

}  // namespace dcnn::identification
