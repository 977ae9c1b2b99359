#include "coupling/statics/push_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

bool remembers(const PushProblem& test) {
  return test.pusher.friction > 0.0 || test.mount.slip_tension || test.wire.yielding ||
         test.wire.strand_friction;
}

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

PushPath::PushPath(const PushProblem& test, const PushOptions& options, StepMeasure measure)
    : options_(options),
      span_(test.mount.span),
      own_steps_(remembers(test) || options.instability == Instability::switch_branch),
      control_{options.smallest_step, measure, options.stop, options.largest_step * span_} {
  // Lengths go as the square root of the error of a step.
  const double coarser = std::sqrt(options.path_tolerance / PushOptions{}.path_tolerance);
  const double share = coarser * span_;
  lengths_ = {1e-3 * share, 5e-4 * share, options.smallest_step, options.largest_step * share};
}

PushCurve PushPath::run(const std::vector<double>& travel) {
  if (numerics::SolveReport report = start(); !report.usable()) {
    curve_.report = std::move(report);
    curve_.newton_iterations = iterations_;
    return std::move(curve_);
  }
  curve_.events.push_back({PushEvent::Kind::first_touch, 0.0});
  curve_.points.reserve(travel.size());
  numerics::SolveReport report = own_steps_ ? by_own_steps(travel) : through_points(travel);
  if (!report.usable()) curve_.report = std::move(report);
  curve_.report.iterations = curve_.newton_iterations;
  return std::move(curve_);
}

numerics::SolveReport PushPath::record_here(double travel) {
  record(travel);
  if (not_finite_) return ended(numerics::Termination::not_finite, "a result is not finite");
  if (options_.progress && !options_.progress(travel)) return interrupted();
  return {};
}

numerics::SolveReport PushPath::ask(double travel) {
  numerics::SolveReport report = follow_to(travel);
  return report.usable() ? record_here(travel) : report;
}

numerics::SolveReport PushPath::through_points(const std::vector<double>& travel) {
  for (const double target : travel) {
    if (target == 0.0 && curve_.points.empty() && record_touch()) continue;
    if (numerics::SolveReport report = ask(target); !report.usable()) return report;
  }
  return {};
}

std::optional<double> PushPath::given_end(double leg_end) const {
  const std::size_t leg = curve_.steps.size() - 1;
  if (leg >= options_.steps.size()) return {};
  const double sense = leg_end < parameter() ? -1.0 : 1.0;
  for (const double end : options_.steps[leg]) {
    if ((end - parameter()) * sense < options_.smallest_step) continue;
    return (leg_end - end) * sense < options_.smallest_step ? leg_end : end;
  }
  return {};
}

// Asked travels from one turning point to the next are a leg.
numerics::SolveReport PushPath::by_own_steps(const std::vector<double>& travel) {
  constexpr double any = std::numeric_limits<double>::infinity();
  OwnSteps own(lengths_);
  OwnSteps given({any, any, lengths_.smallest, any});
  std::size_t next = 0;  // asked point
  if (!travel.empty() && travel[0] == 0.0 && record_touch()) ++next;
  while (next < travel.size()) {
    const double sense = travel[next] < parameter() ? -1.0 : 1.0;
    std::size_t end = next + 1;
    while (end < travel.size() && (travel[end] - travel[end - 1]) * sense >= 0.0) ++end;
    own.turn();
    curve_.steps.emplace_back();
    const auto between = [&](double from, double to, const std::function<void()>& back) {
      curve_.steps.back().push_back(to);
      const double end_of_step = parameter();
      // A point at the end where the path stands is recorded there, below.
      const auto inside = [&] {
        return next < end && (travel[next] - from) * sense > 0.0 &&
               ((to - travel[next]) * sense > 0.0 || (to == travel[next] && to != end_of_step));
      };
      if (!inside()) return numerics::SolveReport();
      const std::function<void()> forth = checkpoint();
      const std::vector<PushEvent> events = curve_.events;
      for (; inside(); ++next) {
        back();
        if (numerics::SolveReport report = ask(travel[next]); !report.usable()) return report;
      }
      forth();
      curve_.events = events;
      return numerics::SolveReport();
    };
    while (next < end) {
      numerics::SolveReport report;
      if (parameter() == travel[next]) {
        report = record_here(travel[next++]);
      } else if (options_.stop && options_.stop()) {
        report = interrupted();
      } else {
        const double from = parameter();
        const std::optional<double> to = given_end(travel[end - 1]);
        report = to ? given.advance(*this, *to, between) : own.advance(*this, travel[end - 1], between);
        if (to && *to == parameter()) given.turn();
        // No step leads on: along the arc of the path, if at all.
        if (!report.usable() && from == parameter() &&
            report.termination != numerics::Termination::interrupted) {
          report = ask(travel[next]);
          ++next;
        }
      }
      if (!report.usable()) return report;
    }
  }
  return {};
}

}  // namespace snare::coupling
