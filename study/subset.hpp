#pragma once

#include "study/proportion.hpp"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace snare::study {

/// Probability of a rare event by levels each of which is not rare (Au, Beck 2001).           theory.md (S.5)
///
/// The cases of a level are Markov chains that start at those of the level before that came nearest to the
/// event. A step is that of Papaioannou, Betz, Zwirglmaier, Straub 2015: z' = sqrt(1 - l^2) z + l xi, kept
/// where it stays in the level; l follows the share of kept steps to 0.44. Random numbers depend on the
/// case's number only, so what was computed can be told again.
class SubsetSimulation {
 public:
  struct Settings {
    std::size_t dimension = 1;
    std::uint64_t cases = 1000;      ///< of a level
    double level_probability = 0.1;  ///< (0, 0.5]
    int most_levels = 12;
    std::uint64_t seed = 1;
  };
  struct Level {
    double threshold = 0.0;    ///< margin that the level's cases reach
    double probability = 0.0;  ///< of the next level's threshold within this one
    /// its coefficient of variation, with the correlation along the chains (Au, Beck 2001, eq. 25-27)
    double variation = 0.0;
  };

  explicit SubsetSimulation(const Settings& settings);

  /// Standard normal scores [-] of the next cases, which may run at a time; none: it is finished.
  [[nodiscard]] const std::vector<std::vector<double>>& next() const noexcept { return asked_; }
  /// Margins of the cases that next() has given, in the field's unit: >= 0 where the event happens; nothing
  /// where the case has no result, which counts as far from the event.
  void tell(const std::vector<std::optional<double>>& margins);

  /// Cases that were told before those of next().
  [[nodiscard]] std::uint64_t told() const noexcept { return told_; }
  [[nodiscard]] bool finished() const noexcept { return asked_.empty(); }
  /// Whether the event was reached; else the probability is that of the last threshold, which bounds it from
  /// above.
  [[nodiscard]] bool reached() const noexcept { return reached_; }
  [[nodiscard]] double probability() const noexcept;
  /// Coefficient of variation, by the scatter over the families of cases that descend from one case of the
  /// first level: it contains the correlation along chains and between levels.                theory.md (S.5)
  [[nodiscard]] double variation() const noexcept;
  /// 95 % interval of the probability. With one level that of a share; with more, Student's t in the
  /// logarithm, with as many degrees of freedom as there are effective families. Where the event was not
  /// reached: from zero to a bound that holds more often.
  [[nodiscard]] ProbabilityInterval interval() const;
  [[nodiscard]] const std::vector<Level>& levels() const noexcept { return levels_; }

 private:
  struct State {
    std::vector<double> scores;
    double margin = 0.0;
  };

  void ask();
  void end_level();
  void begin_level(const std::vector<std::pair<std::size_t, const State*>>& above, double threshold);
  [[nodiscard]] double variation_of(double threshold, double probability) const;
  [[nodiscard]] ProbabilityInterval interval_of_threshold() const;

  Settings settings_;
  std::size_t seeds_ = 1;   // chains of a level
  std::size_t length_ = 1;  // of a chain
  std::vector<std::vector<State>> chains_;
  std::vector<std::size_t> families_;  // of a chain: the case of the first level from which it descends
  std::vector<std::vector<double>> asked_;
  std::vector<Level> levels_;
  double threshold_ = 0.0;  // of the level at hand
  double step_ = 0.6;       // l of the next step
  std::size_t steps_ = 0;   // of the level
  std::uint64_t told_ = 0;
  bool first_ = true;
  bool reached_ = false;
  std::uint64_t hits_ = 0;                  // cases of the last level beyond its threshold
  double family_squares_ = 0.0;             // sum of the squared shares that families have in these
  ProbabilityInterval threshold_interval_;  // of the probability of the last level's threshold
};

}  // namespace snare::study
