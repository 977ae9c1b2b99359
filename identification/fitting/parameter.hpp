#pragma once

#include "identification/fitting/experiment.hpp"
#include "identification/fitting/prediction.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace snare::identification {

/// How a fit moves a number away from its declared value, by a coordinate c that is 0 where nothing changes.
enum class Parametrisation {
  ratio,     ///< declared exp(c): positive quantities that every series may declare for itself
  shift,     ///< declared + c, in SI units
  magnitude  ///< exp(c) in SI units: a threshold that is absent (infinite) in the declared model
};

/// A number that a fit may change. SI units, but for key and unit, which are as in files.
struct Parameter {
  std::string key;         ///< dotted, with its unit: "wire.length_mm"
  std::string unit;        ///< as printed: "mm"; empty for a pure number
  double unit_size = 1.0;  ///< SI value of one unit
  Parametrisation parametrisation = Parametrisation::shift;
  double (*get)(const coupling::PushProblem&, const ReadingModel&) = nullptr;
  void (*set)(coupling::PushProblem&, ReadingModel&, double) = nullptr;
  double (*lower)(const coupling::PushProblem&) = nullptr;  ///< admissible values
  double (*upper)(const coupling::PushProblem&) = nullptr;
  double step = 0.0;    ///< of the coordinate, for differences of the residual, > 0
  double travel = 0.0;  ///< d travel / d coordinate: -1 for the zero of the displacement
  bool reports_change = false;  ///< files show the change from the declared value in place of the value
  std::string only;             ///< name of the one series that it belongs to; empty: all
  bool mount_gives = false;     ///< the compliance of the mounts: differentiated as such where they are rigid

  /// Value for a series that declares `declared`.
  [[nodiscard]] double value(double declared, double coordinate) const;
  /// The same as files show it, in the unit.
  [[nodiscard]] double shown(double declared, double coordinate) const;
  /// Coordinate of a value of that series.
  [[nodiscard]] double coordinate(double declared, double value) const;
};

/// Every number that a fit may change.
[[nodiscard]] const std::vector<Parameter>& all_parameters();

/// Null when there is none of this key. "series[NAME].KEY" is the number KEY of one series alone.
[[nodiscard]] const Parameter* find_parameter(std::string_view key);

/// Throws base::InputError when there is none.
[[nodiscard]] const Parameter& parameter(const std::string& key);

}  // namespace snare::identification
