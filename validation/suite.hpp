#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace snare::validation {

/// Value of a row whose computation failed: out of every limit.
inline constexpr double not_computed = std::numeric_limits<double>::quiet_NaN();

/// Origin of a row's reference. Inputs that are not under test, such as a mass matrix or a contact force of
/// the same run, may come from this code in every kind.
enum class Kind {
  /// Value known from mathematics or mechanics: a formula, a series, a quadrature, the root of an equation,
  /// the state of rest, a symmetry, a balance that has to close or a constraint that has to hold.
  closed_form,
  /// Readings that others measured and published, or their statements about these readings.
  published_measurement,
  /// Number or statement that others computed, fits and models of their own measurements included.
  published_computation,
  /// Result of another formulation or program that shares no equation with the code under test. It may be
  /// written for the purpose, as the elastica by shooting, the continuous wire by collocation and the blind
  /// machines are; records made by such a program count.
  independent_code,
  /// This code compared with itself: on a finer mesh, at a tighter tolerance, at another scale, by another of
  /// its routes (the static solver, the linearised equations), from records that it made; and its numerical
  /// work, such as an observed order or a number of steps. Agreement shows that the discretisation is fine
  /// enough, not that the equations are right.
  convergence,
};

inline constexpr Kind all_kinds[] = {Kind::closed_form, Kind::published_measurement,
                                     Kind::published_computation, Kind::independent_code, Kind::convergence};

/// Name in validation.json, "closed_form".
[[nodiscard]] std::string_view key_of(Kind kind);
/// Name for readers, "closed form".
[[nodiscard]] std::string_view words_of(Kind kind);

enum class ErrorKind { relative, absolute };

/// Largest error that a row may have.
class Limit {
 public:
  /// Of |value - reference|/|reference|. limit: > 0 [-].
  [[nodiscard]] static Limit relative(double limit);
  /// Of |value - reference|. limit: > 0, in the row's unit; reason: why the limit is not relative to the
  /// reference. Throws std::invalid_argument without a reason.
  [[nodiscard]] static Limit absolute(double limit, std::string reason);

  /// Whether the error is relative to the reference or absolute.
  [[nodiscard]] ErrorKind error_kind() const { return error_kind_; }
  /// Largest error: relative [-], or absolute in the row's unit.
  [[nodiscard]] double value() const { return value_; }
  /// Empty for a relative limit.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  Limit(ErrorKind error_kind, double value, std::string reason);
  ErrorKind error_kind_;
  double value_;
  std::string reason_;
};

/// One comparison of a computed value with a reference. A `Limit` has no default, so that a row that leaves
/// out its kind or its limit does not compile.
struct Row {
  std::string group;
  std::string name;
  std::string unit;    ///< of reference and value; empty for a pure number
  std::string source;  ///< of the reference
  Kind kind;           ///< of the reference
  double reference;
  double value;  ///< in the unit
  Limit limit;

  /// |value - reference|, over |reference| for a relative limit. A value that is not finite is out of every
  /// limit.
  [[nodiscard]] double error() const;
  [[nodiscard]] bool within() const { return error() <= limit.value(); }
};

/// Numbers of rows by kind, largest first: "61 closed form, 20 published measurement". Kinds without a row
/// are left out.
[[nodiscard]] std::string count_by_kind(const std::vector<Row>& rows);

/// A named piece of work that yields rows.
struct Check {
  std::string name;
  std::function<std::vector<Row>()> run;
  std::string skipped = {};  ///< why it cannot be run here; empty when it can
};

}  // namespace snare::validation
