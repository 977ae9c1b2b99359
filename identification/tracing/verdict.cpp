#include "identification/tracing/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace snare::identification {

std::string to_string(VerdictKind kind) {
  static constexpr const char* names[] = {"nothing_missing", "explained", "partly_explained", "not_explained",
                                          "cannot_tell"};
  return names[static_cast<std::size_t>(kind)];
}

double peak_force(const Data& data) {
  double peak = 0.0;
  for (const std::size_t k : data.series) peak = std::max(peak, data.measured[k].cwiseAbs().maxCoeff());
  return peak;
}

double model_tolerance(const Experiment& experiment, const Data& data) {
  if (experiment.model_tolerance) return *experiment.model_tolerance * peak_force(data);
  return data.noise.source == "declared" ? 0.0 : usual_tolerance * peak_force(data);
}

std::vector<Finding> beyond_construction(const Model& model, const std::vector<FittedNumber>& numbers,
                                         double factor) {
  constexpr double sure_beyond = 1.5;
  constexpr double rounding = 1e-9;
  const wire::WireSpecification& wire = model.series().front().test.wire;
  std::vector<Finding> findings;
  if (!model.series().front().modulus_declared || !(wire.youngs_modulus > 0.0) || !(wire.diameter > 0.0))
    return findings;
  const double square = wire.diameter * wire.diameter;
  const double area = 0.25 * std::numbers::pi * square;
  for (const FittedNumber& n : numbers) {
    double limit = 0.0;
    if (n.key.ends_with("wire.axial_stiffness_N")) limit = wire.youngs_modulus * area;
    if (n.key.ends_with("wire.bending_stiffness_Nm2")) limit = wire.youngs_modulus * area * square / 16.0;
    if (limit == 0.0 || !(n.lower.value_or(n.value) > (1.0 + rounding) * factor * limit)) continue;
    Finding f{.kind = FindingKind::impossible_stiffness,
              .key = n.key,
              .unit = n.unit,
              .value = n.value,
              .limit = limit};
    f.sure = n.lower && *n.lower > sure_beyond * limit;
    f.what = fmt::format(
        "{} = {:.4g} {} is {:.3g} times that of a solid section of the declared diameter and modulus{}",
        n.key, n.value, n.unit, n.value / limit,
        f.sure ? ": no such wire has it, so the fit stands in for something else" : "");
    findings.push_back(std::move(f));
  }
  return findings;
}

double share_left(const Remainder& base, const Remainder& final) {
  if (!(base.rmse > 0.0)) return 0.0;
  return std::min(1.0, std::pow(final.rmse / base.rmse, 2));
}

bool is_partial(const Remainder& base, const Remainder& final, double peak) {
  return final.upper <= most_force_left * peak && share_left(base, final) <= most_share_left;
}

bool worth_a_name(double before, double after, double fall, double tolerance) {
  constexpr double least_fall = 0.9;
  return fall > tolerance && after <= least_fall * before;
}

bool each_alone(const std::vector<std::vector<std::string>>& classes) {
  return std::all_of(classes.begin(), classes.end(), [](const auto& members) { return members.size() == 1; });
}

bool is_decided(const Evidence& e) {
  constexpr double least_dof = 5.0;
  if (e.dof < least_dof || e.cause_outside || e.one_condition || e.zero_in_doubt || e.something_left ||
      e.numbers_open || e.readings_in_doubt)
    return false;
  if (!each_alone(e.classes)) return false;
  for (std::size_t k = 1; k < e.left_out.size(); ++k) {
    if (!(e.left_out[k] < e.left_out[k - 1])) return false;
  }
  return true;
}

}  // namespace snare::identification
