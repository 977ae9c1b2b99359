#pragma once

#include "base/toml_tree.hpp"
#include "coupling/statics/push_problem.hpp"
#include "identification/fitting/published_scatter.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snare::identification {

/// Readings of one series, in the order in which they were taken. SI units; same length.
struct Readings {
  std::vector<double> displacement;  ///< [m], from first touch as the machine recorded it
  std::vector<double> force;         ///< [N], positive when the wire resists
  std::vector<double> time;          ///< [s]; empty when not recorded
};

/// A published least-squares fit F = A d^2 + B d + C (F in N, d in m) that stands for lost readings.
struct QuadraticLaw {
  double a = 0.0;          ///< [N/m^2]
  double b = 0.0;          ///< [N/m]
  double c = 0.0;          ///< [N]
  double r_squared = 1.0;  ///< coefficient of determination that was printed with it, in (0, 1]
  double to = 0.0;         ///< the range is 0 to this travel [m], > 0
  int r_squared_digits = default_r_squared_digits;  ///< decimals to which r_squared is rounded, 1 to 15

  /// A table that drops trailing zeros prints four decimals as three.
  static constexpr int default_r_squared_digits = 4;

  /// The law's force [N] at a displacement [m].
  [[nodiscard]] double force(double displacement) const noexcept {
    return (a * displacement + b) * displacement + c;
  }
  /// Standard deviation of the lost readings about the law that R^2 implies for readings evenly spread
  /// over the range: sqrt((1 - R^2) / R^2 * variance of the law over the range) [N].
  [[nodiscard]] double scatter() const;
};

/// One series of an experiment file: what is pushed and what was read. Exactly one of `readings`, `law` or
/// neither (prediction only) is set; `test.travel` is filled in each case.
struct Series {
  std::string name;
  coupling::PushProblem test;
  std::optional<Readings> readings;
  std::optional<QuadraticLaw> law;
  std::optional<double> force_sigma;  ///< of one reading [N], > 0
  double position_sigma = 0.0;        ///< of the pusher's place about the declared one [m], >= 0; 0: exact
  bool modulus_declared = true;       ///< else the modulus is the one that gives the declared stiffness
  /// Of all series of the file, which went through one machine: [m], [N]; 0: no readings.
  double largest_displacement = 0.0, largest_force = 0.0;
};

/// How a push of an experiment is discretised and followed: its table [solver].
struct SolverSettings {
  int elements = 256;  ///< edges of the finest mesh, a multiple of 4, 16 to 100000
  coupling::Instability instability = coupling::Instability::follow_path;  ///< at a bifurcation
  bool extrapolate = true;  ///< Richardson extrapolation from this mesh, the half and the quarter one
};

/// What an experiment file says, read and checked; all numbers in SI units.
struct Experiment {
  std::filesystem::path file;
  std::string title;
  std::string source;
  std::vector<Series> series;
  std::vector<std::string> free;     ///< dotted keys that a calibration may change
  std::vector<std::string> heldout;  ///< names of series never used for fitting or selection
  /// Share of the largest measured force below which nothing is called missing, in [0, 0.5]; absent: see
  /// tracing.
  std::optional<double> model_tolerance;
  PublishedScatter published_scatter = PublishedScatter::common;  ///< of lost readings of published fits
  SolverSettings solver;
};

using Override = base::Override;

class ParameterSet;

/// Reads and checks an experiment file and the CSV files it names.
/// Keys, units, ranges and defaults: docs/experiment_file.md. parameters: what [fit] free may name.
/// Throws base::InputError with every problem found (file, line, key, value, what is allowed).
[[nodiscard]] Experiment read_experiment(const std::filesystem::path& file, const ParameterSet& parameters,
                                         const std::vector<Override>& overrides = {});

/// The same from text in memory; CSV files are looked for beside `file`, which need not exist.
[[nodiscard]] Experiment parse_experiment(const std::filesystem::path& file, std::string_view text,
                                          const ParameterSet& parameters,
                                          const std::vector<Override>& overrides = {});

}  // namespace snare::identification
