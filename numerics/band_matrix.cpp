#include "numerics/band_matrix.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace snare::numerics {

void SymmetricBandMatrix::hold(int i) {
  double* c = column(i);
  c[0] = 1.0;
  for (int k = 1; k <= b_; ++k) c[k] = 0.0;
  for (int j = std::max(0, i - b_); j < i; ++j) lower(i, j) = 0.0;
}

Eigen::VectorXd SymmetricBandMatrix::operator*(const Eigen::VectorXd& x) const {
  assert(x.size() == n_);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(n_);
  for (int j = 0; j < n_; ++j) {
    const double* c = column(j);
    const int last = std::min(b_, n_ - 1 - j);
    y[j] += c[0] * x[j];
    for (int k = 1; k <= last; ++k) {
      y[j + k] += c[k] * x[j];
      y[j] += c[k] * x[j + k];
    }
  }
  return y;
}

namespace {

// One column of the factorisation with the bandwidth known to the compiler (Band > 0) or not (Band = 0).
template <int Band>
bool factorize_band(SymmetricBandMatrix& a, std::vector<double>& inverse) {
  const int n = a.order();
  const int b = Band > 0 ? Band : a.half_bandwidth();
  double* base = a.column(0);
  for (int j = 0; j < n; ++j) {
    double* c = base + static_cast<std::size_t>(j) * static_cast<std::size_t>(b + 1);
    const double pivot = c[0];
    if (pivot == 0.0 || !std::isfinite(pivot)) return false;
    const double inv = 1.0 / pivot;
    inverse[static_cast<std::size_t>(j)] = inv;
    const int last = std::min(b, n - 1 - j);
    if (last == b) {
      for (int k = 1; k <= b; ++k) {
        const double l = c[k] * inv;
        double* ck = c + static_cast<std::size_t>(k) * static_cast<std::size_t>(b + 1);
        for (int q = k; q <= b; ++q) ck[q - k] -= l * c[q];
      }
    } else {
      for (int k = 1; k <= last; ++k) {
        const double l = c[k] * inv;
        double* ck = c + static_cast<std::size_t>(k) * static_cast<std::size_t>(b + 1);
        for (int q = k; q <= last; ++q) ck[q - k] -= l * c[q];
      }
    }
    for (int k = 1; k <= last; ++k) c[k] *= inv;
  }
  return true;
}

}  // namespace

bool BandLdlt::factorize(const SymmetricBandMatrix& a) {
  l_ = a;
  const int n = a.order();
  inverse_.resize(static_cast<std::size_t>(n));
  // 5 and 10 are the bandwidths of the planar and of the spatial rod.
  bool factored = false;
  switch (a.half_bandwidth()) {
    case 5:
      factored = factorize_band<5>(l_, inverse_);
      break;
    case 10:
      factored = factorize_band<10>(l_, inverse_);
      break;
    default:
      factored = factorize_band<0>(l_, inverse_);
      break;
  }
  if (!factored) return false;
  double smallest = std::numeric_limits<double>::max();
  double largest = 0.0;
  negative_ = 0;
  share_ = 1.0;
  for (int j = 0; j < n; ++j) {
    const double pivot = *l_.column(j);
    const double diagonal = *a.column(j);
    share_ = std::min(share_, std::abs(pivot) / std::max(std::abs(diagonal), std::abs(diagonal - pivot)));
    negative_ += pivot < 0.0 ? 1 : 0;
    smallest = std::min(smallest, std::abs(pivot));
    largest = std::max(largest, std::abs(pivot));
  }
  ratio_ = smallest / largest;
  return true;
}

namespace {

/// Substitutes forth and back in `width` right-hand sides at once, row by row, entry by entry side by side.
/// The row that is known last comes last, so that little waits for it. Every one has the operations of one
/// alone, in their order. B: the half bandwidth; 0: that of the matrix.
template <int B, int width>
void substitute(const SymmetricBandMatrix& l, const std::vector<double>& inverse, double* first,
                Eigen::Index stride, std::vector<double>& work) {
  using Entries = std::array<double, width>;
  const int n = l.order();
  const int b = B > 0 ? B : l.half_bandwidth();
  work.resize(static_cast<std::size_t>(n) * width);
  double* const w = work.data();
  for (int c = 0; c < width; ++c) {
    const double* x = first + c * stride;
    for (int j = 0; j < n; ++j) w[j * width + c] = x[j];
  }
  const auto take = [](Entries& x, double factor, const double* of) {
    for (int c = 0; c < width; ++c) x[static_cast<std::size_t>(c)] -= factor * of[c];
  };
  Entries x{};
  const auto load = [&x](const double* from) { std::copy_n(from, width, x.begin()); };
  for (int i = 0; i < n; ++i) {
    const Entries before = x;
    double* const here = w + i * width;
    load(here);
    if (i >= b) {
      for (int k = b; k > 1; --k) take(x, l.column(i - k)[k], here - k * width);
    } else {
      for (int k = i; k > 1; --k) take(x, l.column(i - k)[k], here - k * width);
    }
    if (i > 0 && b > 0) take(x, l.column(i - 1)[1], before.data());
    std::copy_n(x.begin(), width, here);
  }
  for (int i = n - 1; i >= 0; --i) {
    const Entries behind = x;
    double* const here = w + i * width;
    const double* const factor = l.column(i);
    load(here);
    for (double& entry : x) entry *= inverse[static_cast<std::size_t>(i)];
    if (i + b < n) {
      for (int k = b; k > 1; --k) take(x, factor[k], here + k * width);
    } else {
      for (int k = n - 1 - i; k > 1; --k) take(x, factor[k], here + k * width);
    }
    if (i + 1 < n && b > 0) take(x, factor[1], behind.data());
    std::copy_n(x.begin(), width, here);
  }
  for (int c = 0; c < width; ++c) {
    double* x_c = first + c * stride;
    for (int j = 0; j < n; ++j) x_c[j] = w[j * width + c];
  }
}

template <int B>
void substitute_all(const SymmetricBandMatrix& l, const std::vector<double>& inverse,
                    Eigen::Ref<Eigen::MatrixXd>& x) {
  thread_local std::vector<double> work;
  Eigen::Index at = 0;
  const Eigen::Index stride = x.outerStride();
  for (; at + 4 <= x.cols(); at += 4) substitute<B, 4>(l, inverse, x.col(at).data(), stride, work);
  for (; at + 2 <= x.cols(); at += 2) substitute<B, 2>(l, inverse, x.col(at).data(), stride, work);
  for (; at < x.cols(); ++at) substitute<B, 1>(l, inverse, x.col(at).data(), stride, work);
}

}  // namespace

void BandLdlt::solve(Eigen::Ref<Eigen::MatrixXd> x) const {
  assert(x.rows() == l_.order());
  switch (l_.half_bandwidth()) {
    case 5:
      return substitute_all<5>(l_, inverse_, x);
    case 10:
      return substitute_all<10>(l_, inverse_, x);
    default:
      return substitute_all<0>(l_, inverse_, x);
  }
}

}  // namespace snare::numerics
