// The noise of poses at rest.
#include "core/linear_algebra.h"
#include "dcnn/core/error.h"
#include "diagnosis/noise_floor.h"

namespace dcnn {

std::vector<Floor> floor_at_rest(const Case& study, const Signals& residual) {
  // Columns: the direction of gravity, an offset and, where the poses have times, its drift.
  const Index width = study.has_clock() ? 5 : 4;
  const double span = std::max(span_seconds(study), 1e-300);
  std::vector<Eigen::VectorXd> rows;
  Eigen::MatrixXd y(0, study.channel_count());
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Motion& motion = study.logs[k].motion;
    for (std::size_t i = 0; i < motion.R_BS.size(); ++i) {
      const auto& R = motion.R_BS[i];
      Eigen::VectorXd row(width);
      row.head<4>() << R(2, 0), R(2, 1), R(2, 2), 1.0;
      if (study.has_clock()) row(4) = motion.t(static_cast<Index>(i)) / span;
      rows.push_back(row);
    }
    const Index before = y.rows();
    y.conservativeResize(before + residual[k].rows(), Eigen::NoChange);
    y.bottomRows(residual[k].rows()) = residual[k];
  }
  Eigen::MatrixXd A(static_cast<Index>(rows.size()), width);
  for (std::size_t i = 0; i < rows.size(); ++i) A.row(static_cast<Index>(i)) = rows[i].transpose();
  const double dof = static_cast<double>(A.rows() - width);
  require(dof >= 3.0, Exit::kData, study.logs.front().recording.name, ": ", A.rows(),
          " poses cannot tell noise from faults; record at least ", width + 3);
  Eigen::MatrixXd gram = A.transpose() * A;
  gram.diagonal().array() += 1e-9;
  std::vector<Floor> floors;
  for (Index j = 0; j < y.cols(); ++j) {
    const Eigen::VectorXd left = y.col(j) - A * solve_symmetric(gram, A.transpose() * y.col(j));
    Floor floor;
    floor.white = left.squaredNorm() / dof;
    floor.source = study.has_clock()
                       ? "poses at rest, beside a free matrix on gravity, an offset and its drift"
                       : "poses at rest, beside a free matrix on gravity and an offset";
    floors.push_back(floor);
  }
  return floors;
}

}  // namespace dcnn
