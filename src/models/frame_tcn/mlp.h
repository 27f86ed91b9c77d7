// SPDX-License-Identifier: Apache-2.0
// A layer of tanh units and a linear one, on columns; parameters live in a flat vector.
#pragma once

#include <Eigen/Dense>

#include "dcnn/core/parallel.h"

namespace dcnn::frame_tcn {

struct Mlp {
  Index inputs = 0, hidden = 0, outputs = 0;

  Index size() const { return hidden * (inputs + 1) + outputs * (hidden + 1); }
  /// y (outputs, n) of x (inputs, n); h (hidden, n) is kept for the gradient.
  void forward(const double* p, const Eigen::MatrixXd& x, Eigen::MatrixXd& h,
               Eigen::MatrixXd& y) const {
    // In place: one column allocates nothing once h and y have their sizes.
    h.resize(hidden, x.cols());
    h.noalias() = W1(p) * x;
    h = (h.colwise() + b1(p)).array().tanh();
    y.resize(outputs, x.cols());
    y.noalias() = W2(p) * h;
    y.colwise() += b2(p);
  }
  /// Adds dLoss/dp to g; x has no gradient.
  void backward(const double* p, const Eigen::MatrixXd& x, const Eigen::MatrixXd& h,
                const Eigen::MatrixXd& dy, double* g) const {
    const Eigen::MatrixXd dh = (W2(p).transpose() * dy).array() * (1.0 - h.array().square());
    Eigen::Map<Eigen::MatrixXd>(g, hidden, inputs) += dh * x.transpose();
    g += hidden * inputs;
    Eigen::Map<Eigen::VectorXd>(g, hidden) += dh.rowwise().sum();
    g += hidden;
    Eigen::Map<Eigen::MatrixXd>(g, outputs, hidden) += dy * h.transpose();
    g += outputs * hidden;
    Eigen::Map<Eigen::VectorXd>(g, outputs) += dy.rowwise().sum();
  }

 private:
  using Matrix = Eigen::Map<const Eigen::MatrixXd>;
  using Vector = Eigen::Map<const Eigen::VectorXd>;
  Matrix W1(const double* p) const { return {p, hidden, inputs}; }
  Vector b1(const double* p) const { return {p + hidden * inputs, hidden}; }
  Matrix W2(const double* p) const { return {p + hidden * (inputs + 1), outputs, hidden}; }
  Vector b2(const double* p) const {
    return {p + hidden * (inputs + 1) + outputs * hidden, outputs};
  }
};

}  // namespace dcnn::frame_tcn
