#include "numerics/correction_guess.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <utility>

namespace snare::numerics {

void CorrectionGuess::begin(long accepted, double before, double time, int order,
                            Eigen::Ref<Eigen::VectorXd> correction) {
  if (states_ == 0) {
    times_[0] = before;
    states_ = 1;
    last_.order = next_.order = -1;
    trusted_ = true;
  } else if (accepted > accepted_) {
    std::shift_right(times_.begin(), times_.end(), 1);
    times_[0] = tried_;
    states_ = std::min(states_ + 1, most);
    std::swap(last_, next_);
    next_.order = -1;
  }
  accepted_ = accepted;
  tried_ = time;
  order_ = states_ > order ? order : -1;
  product_ = 1.0;
  for (int i = 0; i <= order_; ++i) product_ *= time - times_[base::at(i)];
  has_guess_ = order_ >= 0 && last_.order == order_;
  if (has_guess_) guess_ = product_ * last_.value;
  if (has_guess_ && trusted_)
    correction = guess_;
  else
    correction.setZero();
}

void CorrectionGuess::end(const Eigen::Ref<const Eigen::VectorXd>& correction,
                          const Eigen::Ref<const Eigen::VectorXd>& weight) {
  const auto size = [&weight](const auto& v) {
    return v.cwiseProduct(weight).template lpNorm<Eigen::Infinity>();
  };
  if (has_guess_) trusted_ = size(correction - guess_) < size(correction);
  next_.order = order_;
  if (order_ >= 0) next_.value = correction / product_;
}

}  // namespace snare::numerics
