// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/lists.h"
#include "data/limits.h"
#include "dcnn/calibration/calibration.h"
#include "dcnn/core/options.h"

namespace dcnn {
namespace {

constexpr double kMostGain = 1e6;  // or its inverse: micronewtons read as newtons

Json rows_of(const Eigen::Matrix3d& M) {
  Json rows = Json::array();
  for (Index i = 0; i < 3; ++i) rows.push_back({M(i, 0), M(i, 1), M(i, 2)});
  return rows;
}

}  // namespace

Json to_json(const Calibration& c) {
  const Eigen::Vector3d sd = c.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  Json json = {{"rotation_es", rows_of(c.R_ES)},          {"gain", c.gain},
               {"offset_n", json_list(c.offset)},         {"residual_rms_n", c.residual_rms},
               {"rotation_sd_rad", json_list(sd)},        {"pairs", c.pairs},
               {"covariance_rad2", rows_of(c.covariance)}};
  json["mass_kg"] = c.mass_kg ? Json(*c.mass_kg) : Json();
  json["nominal_angle_rad"] = c.nominal_angle ? Json(*c.nominal_angle) : Json();
  json["convention"] = Json();
  if (c.convention) {
    json["convention"] = {{"axes", c.convention->axes},
                          {"force_sign", c.convention->force_sign},
                          {"residual_rms_n", c.convention->residual_rms}};
  }
  json["notes"] = c.notes;
  return json;
}

Calibration read_calibration(const std::filesystem::path& path) {
  const std::string where = path.string();
  Options options(read_json(path, Exit::kData), where, Exit::kData);
  const auto rows = options.get<std::vector<std::vector<double>>>("rotation_es");
  const auto offset = options.get<std::vector<double>>("offset_n", {0.0, 0.0, 0.0});
  require(rows.size() == 3 && offset.size() == 3, Exit::kData, where,
          ": rotation_es must be 3x3 and offset_n a list of 3; write it with dcnn-calibrate");
  Calibration result;
  for (std::size_t i = 0; i < 3; ++i) {
    require(rows[i].size() == 3, Exit::kData, where, ": rotation_es must be 3x3");
    for (std::size_t k = 0; k < 3; ++k) {
      result.R_ES(static_cast<Index>(i), static_cast<Index>(k)) = rows[i][k];
    }
    result.offset[static_cast<Index>(i)] = offset[i];
  }
  const Eigen::Matrix3d error = result.R_ES * result.R_ES.transpose() - Eigen::Matrix3d::Identity();
  require(error.norm() < 1e-6 && result.R_ES.determinant() > 0.0, Exit::kData, where,
          ": rotation_es is not a rotation; write it with dcnn-calibrate");
  require(result.offset.cwiseAbs().maxCoeff() <= kMostMeasured, Exit::kData, where,
          ": offset_n is beyond any sensor; write it with dcnn-calibrate");
  result.gain = options.get<double>("gain", 1.0);
  require(result.gain >= 1.0 / kMostGain && result.gain <= kMostGain, Exit::kData, where,
          ": gain must be between ", 1.0 / kMostGain, " and ", kMostGain,
          "; write it with dcnn-calibrate");
  return result;
}

}  // namespace dcnn
