// The noise of poses at rest.
#include "core/linear_algebra.h"
#include "dcnn/core/error.h"
#include "diagnosis/noise_floor.h"

namespace dcnn {

std::vector<Floor> floor_at_rest(const Case& study, const Signals& residual) {
  std::vector<Eigen::RowVector4d> rows;
  Eigen::MatrixXd y(0, study.channel_count());
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    for (const auto& R : study.logs[k].motion.R_BS) {
      rows.emplace_back(R(2, 0), R(2, 1), R(2, 2), 1.0);
    }
    const Index before = y.rows();
    y.conservativeResize(before + residual[k].rows(), Eigen::NoChange);
    y.bottomRows(residual[k].rows()) = residual[k];
  }
  Eigen::MatrixXd A(static_cast<Index>(rows.size()), 4);
  for (std::size_t i = 0; i < rows.size(); ++i) A.row(static_cast<Index>(i)) = rows[i];
  const double dof = static_cast<double>(A.rows() - 4);
  require(dof >= 3.0, Exit::kData, study.logs.front().recording.name, ": ", A.rows(),
          " poses cannot tell noise from faults; record at least 7");
  Eigen::Matrix4d gram = A.transpose() * A;
  gram.diagonal().array() += 1e-9;
  std::vector<Floor> floors;
  for (Index j = 0; j < y.cols(); ++j) {
    const Eigen::VectorXd left = y.col(j) - A * solve_symmetric(gram, A.transpose() * y.col(j));
    Floor floor;
    floor.white = left.squaredNorm() / dof;
    floor.source = "poses at rest, beside a free matrix on gravity and an offset";
    floors.push_back(floor);
  }
  return floors;
}

}  // namespace dcnn
