#include "coupling/statics/push_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace snare::coupling {

namespace {

bool is_finite(const PushPoint& p) {
  const auto finite = [](double value) { return std::isfinite(value); };
  for (const double value : {p.travel,
                             p.force,
                             p.transverse_force,
                             p.normal_force,
                             p.friction_force,
                             p.axial_force,
                             p.tension_left,
                             p.tension_right,
                             p.contact_coordinate,
                             p.bending_moment,
                             p.wrapped_length,
                             p.energy,
                             p.dissipated,
                             p.imbalance,
                             p.viscous_stiffness,
                             p.largest_tension,
                             p.reaction_along_left,
                             p.reaction_across_left,
                             p.reaction_along_right,
                             p.reaction_across_right}) {
    if (!finite(value)) return false;
  }
  return std::all_of(p.force_by.begin(), p.force_by.end(), finite);
}

}  // namespace

numerics::SolveReport PushPath::ended(numerics::Termination termination, const std::string& message) const {
  numerics::SolveReport report;
  // What stopped the push may have converged by itself and still be of no use.
  report.termination =
      termination == numerics::Termination::converged ? numerics::Termination::step_too_small : termination;
  report.message = fmt::format("{} at a travel of {:.6g} mm", message, 1e3 * point_.parameter);
  return report;
}

numerics::SolveReport PushPath::interrupted() const {
  return ended(numerics::Termination::interrupted, "interrupted");
}

void PushPath::add(PushPoint point) {
  not_finite_ = not_finite_ || !is_finite(point);
  if (not_finite_) return;
  point.iterations = iterations_;
  curve_.newton_iterations += iterations_;
  iterations_ = 0;
  curve_.points.push_back(std::move(point));
}

PushCurve PushPath::run(const std::vector<double>& travel) {
  if (numerics::SolveReport report = start(); !report.usable()) {
    curve_.report = std::move(report);
    curve_.newton_iterations = iterations_;
    return std::move(curve_);
  }
  curve_.events.push_back({PushEvent::Kind::first_touch, 0.0});
  curve_.points.reserve(travel.size());
  for (const double target : travel) {
    if (target == 0.0 && curve_.points.empty() && record_touch()) continue;
    if (numerics::SolveReport report = follow_to(target); !report.usable()) {
      curve_.report = std::move(report);
      break;
    }
    record(target);
    if (not_finite_) {
      curve_.report = ended(numerics::Termination::not_finite, "a result is not finite");
      break;
    }
    if (options_.progress && !options_.progress(target)) {
      curve_.report = interrupted();
      break;
    }
  }
  curve_.report.iterations = curve_.newton_iterations;
  return std::move(curve_);
}

}  // namespace snare::coupling
