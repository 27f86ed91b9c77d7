// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/calibration_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/data/rotation.h"
#include "dcnn/experiment/report.h"
#include "experiment/markup.h"

namespace dcnn {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Standard deviations of small turns about the sensor's axes, rad.
Eigen::Vector3d turn_deviations(const Calibration& c) {
  return c.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

/// Reference less calibrated reading of every pair, (n,3) N.
Eigen::MatrixXd pair_residuals(const Calibration& c, const ForcePairs& pairs) {
  const Eigen::MatrixXd turned = pairs.sensor * c.R_ES.transpose();
  return (pairs.reference - turned).rowwise() - c.offset.transpose();
}

Chart residual_chart(const Eigen::MatrixXd& residuals) {
  Chart chart{"What each pair leaves",
              "pair",
              "reference - calibrated reading [N]",
              {},
              {},
              false,
              720,
              280};
  for (Eigen::Index j = 0; j < 3; ++j) {
    Series series{std::string(1, "xyz"[j]), {}, {}, {}, Series::Style::kMarkers};
    for (Eigen::Index i = 0; i < residuals.rows(); ++i) {
      series.x.push_back(static_cast<double>(i + 1));
      series.y.push_back(residuals(i, j));
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

void add_numbers(const Calibration& c, HtmlReport& page) {
  const Eigen::Vector3d rpy = kDegrees * euler_from_rotation(c.R_ES).reverse();
  const Eigen::Vector3d sd = kDegrees * turn_deviations(c);
  std::vector<std::vector<std::string>> rows;
  for (int i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    rows.push_back({"turn about " + axis + " (Rz·Ry·Rx)", fixed(rpy[i], 2) + "°",
                    "± " + significant(sd[i], 2) + "°"});
  }
  for (int i = 0; i < 3; ++i) {
    rows.push_back(
        {"offset along " + std::string(1, "xyz"[i]), significant(c.offset[i], 3) + " N", ""});
  }
  rows.push_back({"gain (reported, not applied)", fixed(c.gain, 4), ""});
  if (c.mass_kg) rows.push_back({"mass", significant(*c.mass_kg, 4) + " kg", ""});
  if (c.nominal_angle) {
    rows.push_back(
        {"angle to the nominal mounting", fixed(kDegrees * *c.nominal_angle, 2) + "°", ""});
  }
  page.table({"from the sensor's frame to the robot's", "value", "standard deviation"}, rows);
  page.heading("What these numbers are");
  page.paragraph(
      "r = R_ES·s + offset, with s as the sensor reads it and r in the pose frame E. Standard "
      "deviations of turns are about the sensor's axes, from the residuals of the pairs. A gain "
      "far "
      "from 1 means that mass, unit or the sensor's matrix is wrong.");
}

}  // namespace

std::string headline(const Calibration& c) {
  const double angle = kDegrees * angle_between(c.R_ES, Eigen::Matrix3d::Identity());
  const double accuracy = 1.96 * kDegrees * turn_deviations(c).maxCoeff();
  return "The sensor is turned by " + fixed(angle, 2) + "° against the robot's frame, known to ± " +
         significant(accuracy, 2) + "° (95 %); " + std::to_string(c.pairs) +
         " pairs agree with that to " + significant(c.residual_rms, 2) + " N rms.";
}

std::string to_html(const Calibration& c, const ForcePairs& pairs,
                    const std::vector<std::string>& warnings) {
  HtmlReport page("Calibration: the sensor's frame and the robot's");
  page.paragraph(headline(c));
  for (const auto& warning : warnings) page.paragraph(warning);
  page.chart(residual_chart(pair_residuals(c, pairs)),
             "A single pair far from zero was taken wrongly; a wave over the pairs is a turn or an "
             "offset that changed meanwhile.");
  add_numbers(c, page);
  if (!c.notes.empty()) page.heading("Notes of the fit");
  for (const auto& note : c.notes) page.paragraph(note);
  return page.html();
}

}  // namespace dcnn
