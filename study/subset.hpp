#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace snare::study {

/// Probability of a rare event by levels each of which is not rare (Au, Beck 2001).               theory.md (S.5)
///
/// The cases of a level are Markov chains that start at those of the level before that came nearest to the event. A step is
/// that of Papaioannou, Betz, Zwirglmaier, Straub 2015: z' = sqrt(1 - l^2) z + l xi, kept where it stays in the level; l follows
/// the share of kept steps to 0.44. Random numbers depend on the case's number only, so what was computed can be told again.
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
    double variation = 0.0;    ///< its coefficient of variation
  };

  explicit SubsetSimulation(const Settings& settings);

  /// Standard normal scores [-] of the next cases, which may run at a time; none: it is finished.
  [[nodiscard]] const std::vector<std::vector<double>>& next() const noexcept { return asked_; }
  /// Margins of the cases that next() has given, in the field's unit: >= 0 where the event happens; nothing where the case has no result, which
  /// counts as far from the event.
  void tell(const std::vector<std::optional<double>>& margins);

  /// Cases that were told before those of next().
  [[nodiscard]] std::uint64_t told() const noexcept { return told_; }
  [[nodiscard]] bool finished() const noexcept { return asked_.empty(); }
  /// Whether the event was reached; else the probability is a bound from above of what could be seen.
  [[nodiscard]] bool reached() const noexcept { return reached_; }
  [[nodiscard]] double probability() const noexcept;
  /// Coefficient of variation, chains counted as correlated as they are, levels as independent (Au, Beck 2001, eq. 28).
  [[nodiscard]] double variation() const noexcept;
  [[nodiscard]] const std::vector<Level>& levels() const noexcept { return levels_; }

 private:
  struct State {
    std::vector<double> scores;
    double margin = 0.0;
  };

  void ask();
  void end_level();
  [[nodiscard]] double variation_of(double threshold, double probability) const;

  Settings settings_;
  std::size_t seeds_ = 1;   // chains of a level
  std::size_t length_ = 1;  // of a chain
  std::vector<std::vector<State>> chains_;
  std::vector<std::vector<double>> asked_;
  std::vector<Level> levels_;
  double threshold_ = 0.0;  // of the level at hand
  double step_ = 0.6;       // l of the next step
  std::size_t steps_ = 0;   // of the level
  std::uint64_t told_ = 0;
  bool first_ = true;
  bool reached_ = false;
};

}  // namespace snare::study
