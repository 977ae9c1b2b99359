#pragma once

#include "identification/fitting/experiment.hpp"
#include "identification/fitting/model.hpp"
#include "identification/published/curve_likelihood.hpp"

#include <functional>
#include <string>
#include <vector>

namespace snare::identification {

/// A number of a hypothesis with its prior, even between two values or in their logarithm.
struct PriorNumber {
  std::string key;
  double lower = 0.0, upper = 0.0;  ///< in the number's SI unit; of ratios over the declared value
  bool logarithmic = false;
};

/// How published fits may have come about: the declared test with further effects. A zero of the travel a
/// series is part of each.
struct Hypothesis {
  std::string name;     ///< "mount_axial_compliance"
  std::string meaning;  ///< "the mounts give way along the wire"
  /// Of hypotheses that do the same to published fits: "along_the_wire"; else its own name.
  std::string family;
  std::vector<PriorNumber> numbers;
  void (*change)(coupling::PushProblem&) = nullptr;  ///< of the declared test, or null
  /// The smallest linear coefficient of all series is printed a hundred times too small: prior_of_a_slip.
  bool decimal_point = false;
};
/// Prior probability [-], over that of any other hypothesis, that this decimal point slipped in print: 0.05
/// that one did in a table of twelve numbers, by one or two places, either way.
inline constexpr double prior_of_a_slip = 0.05 / 48.0;
/// The published fits as they were before they were printed. laws: one a series.
[[nodiscard]] std::vector<QuadraticLaw> before_print(std::vector<QuadraticLaw> laws,
                                                     const Hypothesis& hypothesis);
/// The declared test; with each effect of the catalogue that published fits can show; with pairs of them; the
/// rope; pinned ends; the inward push; a slip of the decimal point.
[[nodiscard]] std::vector<Hypothesis> published_hypotheses();

/// What a hypothesis makes of the published fits at one range and number of readings.
struct MapCell {
  std::size_t range = 0, readings = 0;
  double log_evidence =
      0.0;                ///< numbers, zeros and scatter integrated out, the mean over a bin of ranges [-]
  double log_best = 0.0;  ///< largest over the numbers, zeros and scatter integrated out [-]
  std::vector<double> values;  ///< of the numbers there, SI
  std::vector<double> to;      ///< the range there, one a series [m]
};
/// A computed test with its posterior weight: its share of the evidence.
struct PosteriorPoint {
  std::vector<double> values;         ///< of the numbers, SI
  double log_weight[2] = {0.0, 0.0};  ///< of log_evidence of the same prior [-]
};
struct HypothesisMap {
  Hypothesis hypothesis;
  std::vector<MapCell> cells;
  std::vector<PosteriorPoint> posterior;
  double effective = 0.0;  ///< computed tests that count: the evidence is known to one part in its root
  /// Numbers of the computed tests with most weight, the first of all.
  std::vector<std::vector<double>> likely;
  double log_evidence[2] = {
      0.0, 0.0};  ///< ranges and numbers integrated out: ranges even in their logarithm, and in themselves
  double probability[2] = {0.0, 0.0};  ///< among all hypotheses
};

/// How finely a map is made.
struct MapOptions {
  FitRanges::Options ranges;
  int elements = 64;                        ///< of the computed wire
  int first = 24, batch = 16, batches = 4;  ///< computed tests a number, see ImportanceSampler
  /// Hypotheses within e^-12 of the leading one are sampled until so many computed tests count, up to
  /// most_batches.
  double effective = 100.0;
  int most_batches = 40;
  std::function<bool(const std::string& stage)> progress = {};
};

/// A map within a minute of one core, for fits that no map is stored of.
[[nodiscard]] MapOptions coarse_map();

/// The evidence of every hypothesis over range and number of readings.                       theory.md (I.33)
[[nodiscard]] std::vector<HypothesisMap> published_map(const Experiment& experiment, const FitRanges& ranges,
                                                       const std::vector<Hypothesis>& hypotheses,
                                                       const MapOptions& options);

/// Something gives along the wire: the family of the wire's own stretch and of its mounts.
inline constexpr const char* along_the_wire = "along_the_wire";
/// The wire slips in a mount, or a mount slides: the family of either mount and both.
inline constexpr const char* slips = "slips";
/// By how much more than declared, wire and mounts together [m/N]; 0 where the hypothesis has neither.
[[nodiscard]] double more_compliance(const Experiment& experiment, const Hypothesis& hypothesis,
                                     const std::vector<double>& values);

/// P [-] that published fits which this hypothesis made, at its leading range and number of readings, are as
/// far from it as these: by a parametric bootstrap of T = max log p(numbers | hypothesis) - max log p(numbers
/// | parabolas, a scatter each), both over ranges and numbers of readings, the former also over `likely`
/// numbers of the test. A multiple of 1 / (replicates + 1).
[[nodiscard]] double published_p(const Experiment& experiment, const FitRanges& printed,
                                 const HypothesisMap& map, const MapOptions& options, int replicates);

/// Forces [N] of the test of a hypothesis, one curve a series, for ranges up to the longest; none where one
/// cannot be computed. values: of its numbers, SI, of ratios over the declared value; elements: of
/// the wire at most.
[[nodiscard]] std::vector<TouchCurve> computed_curves(const Experiment& experiment, const FitRanges& ranges,
                                                      const Hypothesis& hypothesis,
                                                      const std::vector<double>& values, int elements);

/// The cell with most posterior mass, common ranges even in their logarithm.
[[nodiscard]] const MapCell& leading_cell(const HypothesisMap& map, const FitRanges& ranges);

/// Ranges for an experiment of published fits.
[[nodiscard]] FitRanges fit_ranges(const Experiment& experiment, const MapOptions& options);

}  // namespace snare::identification
