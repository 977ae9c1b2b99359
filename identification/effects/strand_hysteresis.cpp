#include "identification/effects/effect.hpp"

#include <cmath>
#include <limits>

namespace snare::identification {

namespace {

/// A breadth below which the strands slide all at once, and one beyond which some hardly slide at all [-].
constexpr double narrowest = 0.05;
constexpr double broadest = 5.0;

/// EI that the strands add while they stick.
Parameter extra_stiffness() {
  return {.key = "strand_hysteresis.extra_stiffness_Nm2",
          .unit = "N m^2",
          .number = {[](const PushProblem& p, const ReadingModel&) {
                       return p.wire.strand_friction ? p.wire.strand_friction->extra_stiffness : 0.0;
                     },
                     [](PushProblem& p, ReadingModel&, double v) {
                       if (!p.wire.strand_friction) p.wire.strand_friction = wire::StrandFriction{0.0, 1.0};
                       p.wire.strand_friction->extra_stiffness = v;
                     }},
          .limits =
              [](const PushProblem& p) {
                return between(1e-4 * p.wire.bending_stiffness(), 1e3 * p.wire.bending_stiffness());
              },
          .step = 1e-6};
}

/// Change of curvature at which they slide.
Parameter slip_curvature() {
  return {.key = "strand_hysteresis.slip_curvature_1_m",
          .unit = "1/m",
          .parametrisation = Parametrisation::magnitude,
          .number = {[](const PushProblem& p, const ReadingModel&) {
                       return p.wire.strand_friction ? p.wire.strand_friction->slip_curvature
                                                     : std::numeric_limits<double>::infinity();
                     },
                     [](PushProblem& p, ReadingModel&, double v) {
                       if (!p.wire.strand_friction) p.wire.strand_friction = wire::StrandFriction{0.0, 1.0};
                       p.wire.strand_friction->slip_curvature = v;
                     }},
          .limits = [](const PushProblem&) { return between(1e-4, 1e3); },
          .step = 1e-3};
}

/// Of the logarithms of the curvatures at which one share of the strands after the other slides.
Parameter slip_breadth() {
  return {.key = "strand_hysteresis.slip_breadth",
          .number = {[](const PushProblem& p, const ReadingModel&) {
                       return p.wire.strand_friction ? p.wire.strand_friction->breadth : 0.0;
                     },
                     [](PushProblem& p, ReadingModel&, double v) {
                       if (p.wire.strand_friction) p.wire.strand_friction->breadth = v;
                     }},
          .limits = [](const PushProblem&) { return between(narrowest, broadest); },
          .step = 1e-3};
}

// With a given slip curvature the force is linear in the extra stiffness, to first order: one amplitude, a
// grid of thresholds; all strands at one curvature, and spread over a factor of e^3.
std::vector<std::vector<double>> trial_slips(const TrialContext& context) {
  std::vector<std::vector<double>> result;
  for (const double share : {0.01, 0.03, 0.1, 0.3, 0.7}) {
    result.push_back({0.3 * context.bending_stiffness, std::log(share * context.highest_curvature), 0.0});
  }
  for (const double share : {0.03, 0.3}) {
    result.push_back({0.3 * context.bending_stiffness, std::log(share * context.highest_curvature), 1.5});
  }
  return result;
}

std::string needs_strand(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.test.wire.construction == wire::Construction::strand) return "";
  }
  return "the wire is declared solid";
}

}  // namespace

/// The strands stick to each other up to a curvature and slide then, all at once or one share after the
/// other: stiff at first, soft later, with a loop.
Effect strand_hysteresis_effect() {
  return {.name = "strand_hysteresis",
          .channel = Channel::wire,
          .meaning = "the strands of the wire stick together and slip when it bends",
          .numbers = {{extra_stiffness(), 0.0, 10.0},
                      {slip_curvature(), 1e-3, 500.0},
                      {slip_breadth(), narrowest, broadest, true}},
          .one_sided = true,
          .trials = trial_slips,
          .unobservable = needs_strand,
          .independent_check =
              "bend a free piece forth and back and look for a loop in moment against curvature"};
}

}  // namespace snare::identification
