// SPDX-License-Identifier: Apache-2.0
// The diagnosis of one case, and of a machine as one case per axis.
#pragma once

#include "diagnosis/axis_case.h"

namespace dcnn {

struct CaseDiagnosis {
  Diagnosis diagnosis;
  Eigen::VectorXd base;  ///< coefficients of the linear simulator where the case has one
  std::vector<double>
      uncorrected;  ///< held-out RMSE of the findings on the simulator as it was given
};
CaseDiagnosis diagnose_case(LoadedCase loaded,
                            const std::function<void(const std::string&)>& progress);

/// Every axis of a machine, in one report in the axes' own names, units and signs.
Diagnosis diagnose_axes(const DiagnosisRequest& request,
                        const std::function<void(const std::string&)>& progress);

}  // namespace dcnn
