#include "dcnn/data/fourier.h"

#include <unsupported/Eigen/FFT>

namespace dcnn {

Index fast_length(Index n) {
  for (;; ++n) {
    Index rest = n;
    for (const Index factor : {2, 3, 5}) {
      while (rest > 1 && rest % factor == 0) rest /= factor;
    }
    if (rest <= 1) return n;
  }
}

Eigen::VectorXcd fourier(const Eigen::VectorXd& x) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXcd half;
  fft.fwd(half, x);
  return half;
}

Eigen::VectorXd inverse_fourier(const Eigen::VectorXcd& half, Index n) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXd x(n);
  fft.inv(x, half, n);
  return x;
}

}  // namespace dcnn
