#include "numerics/quasi_newton.hpp"

namespace snare::numerics {

QuasiNewton::QuasiNewton(Eigen::Index size, int most) : steps_(size, most), squares_(most) {}

void QuasiNewton::update(Eigen::Ref<Eigen::VectorXd> step, const Eigen::Ref<const Eigen::VectorXd>& weight) {
  // of a correction that the next one repeats: beyond it says little about the matrix
  constexpr double most_share = 0.7;
  work_ = weight.cwiseProduct(step);
  const auto share = [&](Eigen::Index i) { return steps_.col(i).dot(work_) / squares_[i]; };
  if (kept_ > 0) {
    for (Eigen::Index i = 0; i + 1 < kept_; ++i) work_ += share(i) * steps_.col(i + 1);
    const double last = share(kept_ - 1);
    if (last < most_share) {
      work_ /= 1.0 - last;
      step = work_.cwiseQuotient(weight);
    } else {
      work_ = weight.cwiseProduct(step);
      kept_ = 0;
    }
  }
  if (kept_ == steps_.cols()) return;
  const double square = work_.squaredNorm();
  if (!(square > 0.0)) return;
  steps_.col(kept_) = work_;
  squares_[kept_] = square;
  ++kept_;
}

}  // namespace snare::numerics
