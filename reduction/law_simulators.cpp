#include "reduction/law_simulators.hpp"

#include <algorithm>
#include <cmath>

namespace snare::reduction {

namespace {

scenario::DistilledLoss loss_of(const DistilledPlace& place) {
  scenario::DistilledLoss loss;
  loss.position = place.position;
  if (place.load_unload) {
    const LoadUnloadFit& fit = *place.load_unload;
    loss.loop = {fit.law.returned(), fit.law.turn(), fit.loop};
  }
  const auto damped =
      std::ranges::find_if(place.impacts, [](const ImpactDamping& i) { return i.damping.has_value(); });
  if (damped != place.impacts.end()) loss.dashpot = {damped->speed, damped->restitution, *damped->damping};
  return loss;
}

numerics::HermiteCurve curve_of(const DistilledCase& one, const DistilledPlace& place) {
  return one.table.loading->curve(place.position, one.wire.test.wire.length - one.wire.test.mount.span);
}

}  // namespace

std::vector<MujocoLaw> mujoco_laws(const DistilledCase& one) {
  std::vector<MujocoLaw> laws;
  for (const DistilledPlace& place : one.places) {
    const auto linear =
        std::ranges::find(place.laws, "linear", [](const FittedLaw& law) { return law.form->name(); });
    laws.push_back(mujoco_law(place.position, curve_of(one, place),
                              linear == place.laws.end() ? std::nullopt : std::optional(linear->values[0]),
                              loss_of(place)));
  }
  return laws;
}

std::vector<double> mujoco_errors(const DistilledCase& one) {
  constexpr int points = 800;
  std::vector<double> errors;
  for (const DistilledPlace& place : one.places) {
    const numerics::HermiteCurve curve = curve_of(one, place);
    double largest = 0.0;
    for (int i = 0; i <= points; ++i) {
      const double d = curve.knots().back() * i / points;
      largest = std::max(largest, std::abs(curve.value(d) - place.full.value(d)));
    }
    errors.push_back(largest);
  }
  return errors;
}

}  // namespace snare::reduction
