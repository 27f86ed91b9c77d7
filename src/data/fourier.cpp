// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/fourier.h"

#include <array>
#include <complex>
#include <numbers>
#include <vector>

#include "core/elementary.h"

namespace dcnn {
namespace {

using Complex = std::complex<double>;

using Signal = std::vector<Complex>;

Complex& at(Signal& x, Index k) { return x[static_cast<std::size_t>(k)]; }
const Complex& at(const Signal& x, Index k) { return x[static_cast<std::size_t>(k)]; }

/// exp(-2 pi i k/n), k = 0 … n-1.
Signal roots_of_unity(Index n) {
  Signal roots(static_cast<std::size_t>(n), 1.0);
  for (Index k = 1; 2 * k <= n; ++k) {
    const double turn = static_cast<double>(k) / static_cast<double>(n);
    const Complex root = elementary::polar(1.0, -2.0 * std::numbers::pi * turn);
    at(roots, k) = root;
    at(roots, n - k) = std::conj(root);
  }
  return roots;
}

/// a·b without the care that operator* takes of infinities.
Complex product(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// The transform of one length, by decimation in time (Cooley and Tukey 1965) with the prime
/// factors of the length and 4, which is quicker than two steps of 2.
class Transform {
 public:
  /// Of length n, with the roots of unity of order n·step.
  Transform(Index n, const Signal& roots, Index step) : n_(n), roots_(roots), step_(step) {}

  Signal operator()(const Signal& x) const {
    Signal out(x.size());
    if (n_ > 0) pass(x.data(), 1, out.data(), n_);
    return out;
  }

 private:
  static Index factor(Index n) {
    if (n % 4 == 0) return 4;
    for (Index p = 2; p * p <= n; ++p) {
      if (n % p == 0) return p;
    }
    return n;
  }

  /// `out`, (n), of every stride-th value of `in`; n·stride is the whole length.
  void pass(const Complex* in, Index stride, Complex* out, Index n) const {
    const Index p = factor(n), part = n / p;
    for (Index q = 0; q < p; ++q) {
      if (part > 1) {
        pass(in + q * stride, stride * p, out + q * part, part);
      } else {
        out[q] = in[q * stride];
      }
    }
    switch (p) {
      case 2:
        return join<2>(out, part, stride);
      case 3:
        return join<3>(out, part, stride);
      case 4:
        return join<4>(out, part, stride);
      case 5:
        return join<5>(out, part, stride);
      default:
        join_any(out, p, part, stride);
    }
  }

  /// P transforms of length `part` become one of length P·part.
  template <Index P>
  void join(Complex* out, Index part, Index stride) const {
    std::array<Complex, P> turn, x;
    for (Index r = 0; r < P; ++r) turn[static_cast<std::size_t>(r)] = root(r * part * stride);
    for (Index k = 0; k < part; ++k) {
      x[0] = out[k];
      for (Index q = 1; q < P; ++q) {
        x[static_cast<std::size_t>(q)] = product(out[q * part + k], root(q * k * stride));
      }
      if constexpr (P == 4) {
        const Complex a = x[0] + x[2], b = x[0] - x[2], c = x[1] + x[3], d = x[1] - x[3];
        const Complex quarter(d.imag(), -d.real());  // -i d
        out[k] = a + c;
        out[k + part] = b + quarter;
        out[k + 2 * part] = a - c;
        out[k + 3 * part] = b - quarter;
      } else {
        for (std::size_t r = 0; r < P; ++r) {
          Complex sum = x[0];
          for (std::size_t q = 1; q < P; ++q) sum += product(x[q], turn[q * r % P]);
          out[k + static_cast<Index>(r) * part] = sum;
        }
      }
    }
  }

  void join_any(Complex* out, Index p, Index part, Index stride) const {
    Signal x(static_cast<std::size_t>(p));
    for (Index k = 0; k < part; ++k) {
      for (Index q = 0; q < p; ++q) at(x, q) = out[q * part + k];
      for (Index r = 0; r < p; ++r) {
        Complex sum = x[0];
        const Index turn = (k + r * part) * stride;
        for (Index q = 1, turned = turn; q < p; ++q, turned = (turned + turn) % n_) {
          sum += product(at(x, q), root(turned));
        }
        out[k + r * part] = sum;
      }
    }
  }

  const Complex& root(Index k) const { return at(roots_, k * step_); }

  Index n_;
  const Signal& roots_;
  Index step_;
};

Index largest_factor(Index n) {
  Index largest = 1;
  for (Index p = 2; n > 1; ++p) {
    if (p * p > n) p = n;
    for (; n % p == 0; n /= p) largest = p;
  }
  return largest;
}

}  // namespace

Index fast_length(Index n) {
  for (;; ++n) {
    Index rest = n;
    for (const Index factor : {2, 3, 5}) {
      while (rest > 1 && rest % factor == 0) rest /= factor;
    }
    if (rest <= 1) return n;
  }
}

/// The transform of one length N by a convolution (Bluestein 1970), since j k = (j^2 + k^2 - (k -
/// j)^2)/2: X_k = c_k sum_j (x_j c_j) conj(c_(k-j)) with c_j = exp(-pi i j^2/N).
class Fourier::Chirp {
 public:
  explicit Chirp(Index n) : n_(n), m_(fast_length(2 * n - 1)), roots_(roots_of_unity(m_)) {
    const Signal half = roots_of_unity(2 * n);
    for (Index j = 0; j < n; ++j) chirp_.push_back(at(half, j * j % (2 * n)));
    Signal kernel(static_cast<std::size_t>(m_));
    for (Index j = 0; j < n; ++j)
      at(kernel, j) = at(kernel, (m_ - j) % m_) = std::conj(at(chirp_, j));
    kernel_ = Transform(m_, roots_, 1)(kernel);
  }
  Signal operator()(const Signal& x) const {
    Signal padded(static_cast<std::size_t>(m_));
    for (Index j = 0; j < n_; ++j) at(padded, j) = product(at(x, j), at(chirp_, j));
    Signal spectrum = Transform(m_, roots_, 1)(padded);
    // The inverse by the transform of the conjugate.
    for (Index k = 0; k < m_; ++k) {
      at(spectrum, k) = std::conj(product(at(spectrum, k), at(kernel_, k)));
    }
    const Signal sum = Transform(m_, roots_, 1)(spectrum);
    Signal X(static_cast<std::size_t>(n_));
    for (Index k = 0; k < n_; ++k) {
      at(X, k) = product(std::conj(at(sum, k)), at(chirp_, k)) / static_cast<double>(m_);
    }
    return X;
  }

 private:
  Index n_, m_;
  Signal roots_, chirp_, kernel_;
};

Fourier::Fourier(Index n) : n_(n), roots_(roots_of_unity(n)) {
  constexpr Index kMostFactor = 61;  // about as quick as a convolution
  const Index length = n % 2 ? n : n / 2;
  if (largest_factor(length) > kMostFactor) chirp_ = std::make_shared<const Chirp>(length);
}

std::vector<std::complex<double>> Fourier::transformed(const Signal& x) const {
  if (chirp_) return (*chirp_)(x);
  return Transform(static_cast<Index>(x.size()), roots_, n_ % 2 ? 1 : 2)(x);
}

// A real signal of even length n = 2h is transformed as the complex signal z_j = x_2j + i x_2j+1 of
// length h, since X_k = E_k + w^k O_k with w = exp(-2 pi i/n) and Z_k = E_k + i O_k, E and O being
// the transforms of the real signals x_2j and x_2j+1, hence E_h-k = conj(E_k).

Eigen::VectorXcd Fourier::operator()(const Eigen::VectorXd& x) const {
  if (n_ % 2 || n_ == 0) {
    const Signal whole = transformed(Signal(x.data(), x.data() + n_));
    return Eigen::Map<const Eigen::VectorXcd>(whole.data(), std::min(n_, n_ / 2 + 1));
  }
  const Index h = n_ / 2;
  Signal z(static_cast<std::size_t>(h));
  for (Index j = 0; j < h; ++j) at(z, j) = {x(2 * j), x(2 * j + 1)};
  const Signal Z = transformed(z);
  Eigen::VectorXcd X(h + 1);
  for (Index k = 0; k <= h; ++k) {
    const Complex a = at(Z, k % h), b = std::conj(at(Z, (h - k) % h));
    X(k) = 0.5 * (a + b) + product(at(roots_, k), product({0.0, -0.5}, a - b));
  }
  return X;
}

// By the transform of the conjugate, whose conjugate is n times the signal.
Eigen::VectorXd Fourier::inverse(const Eigen::VectorXcd& X) const {
  if (n_ % 2) {
    Signal whole(static_cast<std::size_t>(n_), std::conj(X(0)));
    for (Index k = 1; 2 * k < n_; ++k) {
      at(whole, k) = std::conj(X(k));
      at(whole, n_ - k) = X(k);
    }
    const Signal x = transformed(whole);
    return Eigen::Map<const Eigen::VectorXcd>(x.data(), n_).real() / static_cast<double>(n_);
  }
  const Index h = n_ / 2;
  Signal Z(static_cast<std::size_t>(h));
  for (Index k = 0; k < h; ++k) {
    const Complex a = X(k), b = std::conj(X(h - k));
    const Complex odd = product(std::conj(at(roots_, k)), a - b);
    at(Z, k) = std::conj(a + b + product({0.0, 1.0}, odd));
  }
  const Signal z = transformed(Z);
  Eigen::VectorXd x(n_);
  for (Index j = 0; j < h; ++j) {
    x(2 * j) = at(z, j).real() / static_cast<double>(n_);
    x(2 * j + 1) = -at(z, j).imag() / static_cast<double>(n_);
  }
  return x;
}

Eigen::VectorXcd fourier(const Eigen::VectorXd& x) { return Fourier(x.size())(x); }

Eigen::VectorXd cosine_transform(const Eigen::VectorXd& x) {
  const Index n = x.size();
  Eigen::VectorXd mirrored(2 * n);  // whose transform is 2 exp(i pi k/(2 N)) times the sum
  mirrored << x, x.reverse();
  const Eigen::VectorXcd X = fourier(mirrored);
  Eigen::VectorXd sums(n);
  for (Index k = 0; k < n; ++k) {
    const double half = -std::numbers::pi * static_cast<double>(k) / (2.0 * static_cast<double>(n));
    sums(k) = 0.5 * product(X(k), elementary::polar(1.0, half)).real();
  }
  return sums;
}

}  // namespace dcnn
