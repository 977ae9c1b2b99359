#pragma once

#include "coupling/statics/push_problem.hpp"
#include "identification/fitting/reading_model.hpp"

#include <array>
#include <string>
#include <vector>

namespace snare::identification {

using coupling::PushProblem;

/// How a fit moves a number away from its declared value, by a coordinate c that is 0 where nothing changes.
enum class Parametrisation {
  ratio,     ///< declared exp(c): positive quantities that every series may declare for itself
  shift,     ///< declared + c, in SI units
  magnitude  ///< exp(c) in SI units: a threshold that is absent (infinite) in the declared model
};

/// Where a number acts, which decides how the recorded force is differentiated by it.         theory.md (I.2)
enum class Derivative {
  push,    ///< of the push: implicit differentiation of the equilibrium
  travel,  ///< of the record, moves the travels at which it was taken: by the slope of the curve
  record,  ///< of the record, at the same travels
  rate     ///< of the record, with the viscous stiffness of the wire
};

/// How a number is read and written.
struct Access {
  double (*get)(const PushProblem&, const ReadingModel&) = nullptr;
  void (*set)(PushProblem&, ReadingModel&, double) = nullptr;
};

/// Access to a plain member: member([](auto& p, auto&) -> auto& { return p.wire.length; }).
template <class Member>
[[nodiscard]] Access member(Member) {
  return {[](const PushProblem& p, const ReadingModel& r) -> double { return Member{}(p, r); },
          [](PushProblem& p, ReadingModel& r, double v) { Member{}(p, r) = v; }};
}

/// Between which values a number is admissible, ends included, in its SI unit.
struct Limits {
  double lower = 0.0, upper = 0.0;
};
/// These limits, in the number's SI unit.
[[nodiscard]] inline Limits between(double lower, double upper) {
  return {lower, upper};
}

/// A number that a fit may change: what it is called, how it enters the model, what it may be. SI units, but
/// for key and unit, which are as in files. A number of an effect stands in the effect's file
/// (identification/effects), others in construction_numbers.cpp.
struct Parameter {
  std::string key{};       ///< dotted, with its unit: "wire.length_mm"
  std::string unit{};      ///< as printed: "mm"; empty for a pure number
  double unit_size = 1.0;  ///< SI value of one unit
  Parametrisation parametrisation = Parametrisation::shift;
  Access number{};
  Limits (*limits)(const PushProblem&) = nullptr;  ///< admissible values
  double step = 0.0;  ///< of the coordinate, for differences of the residual, > 0
  Derivative derivative = Derivative::push;
  bool reports_change = false;  ///< files show the change from the declared value in place of the value
  /// Of a compliance along the chord: 1 for the left and the right mount that is rigid and gives by this
  /// number, else 0; rigid mounts are differentiated as such. Null: the number is no such compliance.
  std::array<double, 2> (*mounts_give)(const PushProblem&) = nullptr;
  /// Why the forces of a test cannot depend on it; empty: they may. Null: they always may, or its effect says
  /// why.
  const char* (*unseen)(const PushProblem&) = nullptr;
  std::string only{};  ///< name of the one series that it belongs to; empty: all

  /// Value for a series that declares `declared`.
  [[nodiscard]] double value(double declared, double coordinate) const;
  /// The same as files show it, in the unit.
  [[nodiscard]] double shown(double declared, double coordinate) const;
  /// Coordinate of a value of that series.
  [[nodiscard]] double coordinate(double declared, double value) const;
};

/// Whether both stiffnesses are declared, so that they do not follow from diameter and modulus.
[[nodiscard]] bool stiffnesses_declared(const PushProblem& test);
/// Whether no gravity acts.
[[nodiscard]] bool weightless(const PushProblem& test);

/// Numbers of the declared construction, which belong to no effect: sizes and material.
[[nodiscard]] const std::vector<Parameter>& construction_numbers();

}  // namespace snare::identification
