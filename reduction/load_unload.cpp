#include "reduction/load_unload.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace snare::reduction {

LoadUnloadLaw::LoadUnloadLaw(numerics::HermiteCurve loading, double returned, double turn)
    : loading_(std::move(loading)), returned_(returned), turn_(turn) {}

double LoadUnloadLaw::move(LoadUnloadState& state, double travel) const {
  state.branch = std::clamp(state.branch + 2.0 * (travel - state.travel) / turn_, -1.0, 1.0);
  state.travel = travel;
  if (travel < 0.0) {
    state.branch = 1.0;  // no contact: the next touch begins afresh
    return 0.0;
  }
  return loading_.value(travel) * 0.5 * ((1.0 + returned_) + state.branch * (1.0 - returned_));
}

Dissipation dissipation(const numerics::HermiteCurve& loading, const numerics::HermiteCurve& unloading) {
  Dissipation result;
  const double end = loading.knots().back();
  result.absorbed = loading.integral(end);
  result.loop = result.absorbed - unloading.integral(end);
  const double stored = result.absorbed - 0.5 * result.loop;
  result.loss_factor = stored > 0.0 ? result.loop / (2.0 * std::numbers::pi * stored) : 0.0;
  result.damping_times_rate = result.loop / (std::numbers::pi * 0.25 * end * end);
  return result;
}

LoadUnloadFit fit_load_unload(const numerics::HermiteCurve& loading,
                              const numerics::HermiteCurve& unloading) {
  const std::vector<double>& travel = loading.knots();
  const double end = travel.back();
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < travel.size(); i += 3) {
    if (travel[i] > 0.8 * end) continue;
    product += loading.value(travel[i]) * unloading.value(travel[i]);
    square += loading.value(travel[i]) * loading.value(travel[i]);
  }
  const double returned = square > 0.0 ? std::clamp(product / square, 0.0, 1.0) : 1.0;
  const auto misfit = [&](double turn, std::size_t offset, double& largest) {
    const LoadUnloadLaw law(loading, returned, turn);
    LoadUnloadState state{1.0, end};
    double sum = 0.0;
    std::size_t count = 0;
    largest = 0.0;
    for (std::size_t i = travel.size(); i-- > 0;) {
      const double miss = law.move(state, travel[i]) - unloading.value(travel[i]);
      if (i % 3 == 0 ? offset != 0 : offset == 0) continue;
      sum += miss * miss;
      largest = std::max(largest, std::abs(miss));
      ++count;
    }
    return std::sqrt(sum / static_cast<double>(count));
  };
  double best = std::numeric_limits<double>::infinity();
  double turn = 0.1 * end;
  double unused = 0.0;
  double share = 1e-3;
  while (share < 1.0) {
    const double rms = misfit(share * end, 0, unused);
    if (rms < best) {
      best = rms;
      turn = share * end;
    }
    share *= 1.05;
  }
  LoadUnloadFit fit{LoadUnloadLaw(loading, returned, turn)};
  fit.rms_error = misfit(turn, 1, fit.largest_error);
  LoadUnloadState state{1.0, end};
  std::vector<double> back(travel.size());
  for (std::size_t i = travel.size(); i-- > 0;) back[i] = fit.law.move(state, travel[i]);
  fit.loop = loading.integral(end) - numerics::HermiteCurve(travel, back).integral(end);
  return fit;
}

}  // namespace snare::reduction
