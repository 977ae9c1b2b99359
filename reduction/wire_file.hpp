#pragma once

#include "base/toml_tree.hpp"
#include "coupling/statics/push_problem.hpp"
#include "reduction/impact_damping.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snare::reduction {

/// An interval that is asked for; low == high is a fixed value.
struct Interval {
  double low = 0.0;   ///< in SI units
  double high = 0.0;  ///< in SI units

  [[nodiscard]] bool fixed() const noexcept { return low == high; }                       ///< one value
  [[nodiscard]] double middle() const noexcept { return 0.5 * (low + high); }             ///< in SI units
  [[nodiscard]] bool contains(double x) const noexcept { return x >= low && x <= high; }  ///< ends count
};

/// One wire with its pusher, and the ranges over which its force is asked. SI units.
struct WireCase {
  coupling::PushProblem test;         ///< nominal; position, length and travel are set by the sampling
  Interval travel;                    ///< from first touch; low is 0 [m]
  Interval position;                  ///< s, of the pusher along the chord from the left mount [m]
  Interval slack;                     ///< length less span [m]
  std::vector<double> law_positions;  ///< s at which simple laws are fitted, at the nominal slack [m]
  /// Displacement that a machine recorded at first touch, one a law position, >= 0; empty: none [m].
  std::vector<double> law_offsets;

  /// Left and right are alike: s beyond mid-span is s from the other end, and half the positions suffice.
  [[nodiscard]] bool symmetric() const noexcept;
  /// Load and unload differ: friction, sliding strands, yielding, a mount that slips.
  [[nodiscard]] bool dissipates() const noexcept;
  [[nodiscard]] double nominal_slack() const noexcept { return test.wire.length - test.mount.span; }
};

/// Numbers of knots of a table in travel, position and slack.
using TablePoints = std::array<int, 3>;

/// How fine a table is made and how exact the curves behind it are.
struct DistilSettings {
  int elements = 256;                   ///< edges of the finest mesh, a multiple of 4, >= 16
  bool extrapolate = true;              ///< from this mesh, the half and the quarter one
  TablePoints points{20, 9, 5};         ///< to begin with
  TablePoints most_points{64, 65, 33};  ///< to which knots are added while the error is above the tolerance
  double tolerance = 0.005;             ///< largest error of the table over the range of the force [-]
};

/// What `snare distil` works on: a case for every combination of the listed values.
struct WireFile {
  std::filesystem::path file;
  std::string title;
  std::string source;
  std::vector<WireCase> cases;  ///< the first has the first value of every list
  DistilSettings settings;
  std::optional<ImpactSettings> impacts;  ///< damping from dynamic runs is asked
  std::string export_name;  ///< what keeps exports apart: namespace, prefix, package; empty: none
};

/// Travel from first touch at which the wire, taken as two straight pieces at mid-span, is stretched by the
/// strain that metals bear elastically (0.2 %, the usual proof strain): the default end of the travel [m].
///                                                                                            theory.md (R.1)
[[nodiscard]] double default_travel(const coupling::PushProblem& test);

/// Reads and checks a wire file: keys, units, ranges and defaults in docs/wire_file.md. Throws
/// base::InputError with every problem found (file, line, key, value, what is allowed).
[[nodiscard]] WireFile read_wire_file(const std::filesystem::path& file,
                                      const std::vector<base::Override>& overrides = {});
[[nodiscard]] WireFile parse_wire_file(const std::filesystem::path& file, std::string_view text,
                                       const std::vector<base::Override>& overrides = {});

}  // namespace snare::reduction
