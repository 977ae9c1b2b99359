#include "coupling/statics/path_follower.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

namespace {

// A remainder shorter than a tenth of the step is taken with it: points too near each other spoil a
// predictor.
constexpr double with_remainder = 1.1;
constexpr double to_event = 1.000001;  // not beyond it

// Largest difference between two solutions at the end of a step, over its allowed value.
double error_of(const RememberingPath::Measures& whole, const RememberingPath::Measures& halves) {
  return ((whole.values - halves.values).array().abs() / halves.allowed.array()).maxCoeff();
}

}  // namespace

numerics::SolveReport follow(FollowedPath& path, double target, const StepControl& control) {
  double step = target - path.parameter();
  double stretch = with_remainder;
  numerics::SolveReport report;
  while (path.parameter() != target) {
    if (control.stop && control.stop()) return report.end(numerics::Termination::interrupted, "interrupted");
    const double from = path.parameter();
    const double rest = target - from;
    if (std::abs(step) > std::abs(rest) || step * rest <= 0.0) step = rest;
    step = std::clamp(step, -control.largest_step, control.largest_step);
    const double next = stretch * std::abs(step) >= std::abs(rest) ? target : from + step;
    const double length = control.measure == StepMeasure::attempted ? next - from : step;
    stretch = with_remainder;
    const StepOutcome outcome = path.step_to(next);
    report = outcome.report;
    switch (outcome.kind) {
      case StepOutcome::Kind::taken:
        step = 2.0 * length;
        break;
      case StepOutcome::Kind::event:
        step = outcome.fraction * length;
        stretch = to_event;
        break;
      case StepOutcome::Kind::elsewhere:
        step = target - path.parameter();
        break;
      case StepOutcome::Kind::failed:
        step = 0.5 * length;
        if (std::abs(step) < control.smallest_step) return path.without_steps(target, report);
        break;
      case StepOutcome::Kind::stopped:
        return report;
    }
  }
  return report;
}

bool OwnSteps::shorten(const StepOutcome& outcome, double length) {
  if (outcome.kind == StepOutcome::Kind::event) {
    step_ = outcome.fraction * length;
    resumed_ = length;
    return true;
  }
  step_ = 0.5 * length;
  resumed_ = 0.0;
  return outcome.kind == StepOutcome::Kind::failed && step_ >= lengths_.smallest;
}

numerics::SolveReport OwnSteps::advance(RememberingPath& path, double target, const Accepted& accepted) {
  using Kind = StepOutcome::Kind;
  for (;;) {
    const double from = path.parameter();
    const double rest = target - from;
    const double stretch = resumed_ > 0.0 ? to_event : with_remainder;
    const double to = stretch * step_ >= std::abs(rest) ? target : from + std::copysign(step_, rest);
    const double length = std::abs(to - from);
    const std::function<void()> back = path.checkpoint();
    double tried = length;
    const bool at_once = length <= lengths_.finest;
    StepOutcome outcome = at_once ? path.step_to(to) : path.try_step_to(to);
    if (outcome.kind == Kind::elsewhere && !at_once) {
      back();
      outcome = path.step_to(to);
    } else if (outcome.kind == Kind::taken && !at_once) {
      const RememberingPath::Measures whole = path.measures();
      back();
      tried = 0.5 * length;
      outcome = path.step_to(0.5 * (from + to));
      if (outcome.kind == Kind::taken) {
        const double middle = path.parameter();
        const std::function<void()> back_to_middle = path.checkpoint();
        outcome = path.step_to(to);
        if (outcome.kind != Kind::taken && outcome.kind != Kind::elsewhere) {
          // The first half is accepted; the second is tried again from there.
          step_ = 0.5 * length;
          resumed_ = 0.0;
          if (outcome.kind != Kind::stopped) static_cast<void>(shorten(outcome, tried));
          return accepted(from, middle, back);
        }
        const double error = outcome.kind == Kind::taken ? error_of(whole, path.measures()) : 0.0;
        if (error > 1.0) {
          back();
          step_ = length * std::clamp(0.9 / std::sqrt(error), 0.1, 0.7);
          resumed_ = 0.0;
          continue;
        }
        numerics::SolveReport report = accepted(from, middle, back);
        if (report.usable()) report = accepted(middle, path.parameter(), back_to_middle);
        const double grown = length * std::min(2.0, 0.9 / std::sqrt(error + 1e-9));
        step_ = std::min(lengths_.largest, std::max(grown, 0.25 * resumed_));
        if (outcome.kind == Kind::elsewhere) step_ = lengths_.first;
        resumed_ = 0.0;
        return report;
      }
    }
    if (outcome.kind == Kind::taken || outcome.kind == Kind::elsewhere) {
      step_ = outcome.kind == Kind::taken ? std::max(2.0 * tried, 0.25 * resumed_) : lengths_.first;
      resumed_ = 0.0;
      return accepted(from, path.parameter(), back);
    }
    if (!shorten(outcome, tried)) return outcome.report;
  }
}

}  // namespace snare::coupling
