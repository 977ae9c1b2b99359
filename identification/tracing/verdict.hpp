#pragma once

#include "identification/tracing/model_error.hpp"
#include "identification/tracing/remainder.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// How far a trace explains the readings.                                            theory.md (I.9)
enum class VerdictKind {
  nothing_missing,   ///< the base model does: what it leaves is noise, or within the tolerance
  explained,         ///< the base model with the selected effects does
  partly_explained,  ///< the selected effects carry nearly all; what is left is small and said
  not_explained,
  /// the base model leaves noise only, but the readings do not determine its numbers: theory.md (I.32)
  cannot_tell
};
[[nodiscard]] std::string to_string(VerdictKind kind);

/// What is left after the final model, when it is more than noise.
struct Remaining {
  double rmse = 0.0;             ///< [N]
  double upper = 0.0;            ///< 95 % [N]
  double share_of_excess = 0.0;  ///< of what the base model leaves beside the noise, as mean squares
  std::string channel;           ///< where it comes nearest to; empty: nothing is left, or not asked
};

/// Limits of a partial answer: 2 % of the excess, and 3 % of the largest force with 95 % confidence.
inline constexpr double most_share_left = 0.02;
inline constexpr double most_force_left = 0.03;
/// Share of the largest force that may hide in the noise, with 95 % confidence, where nothing is said to be
/// missing.
inline constexpr double most_hidden = 0.05;
/// Share of the largest force below which nothing is called missing, unless the file says otherwise.
inline constexpr double usual_tolerance = 0.01;

/// Largest measured force of the fitted readings, either sign [N].
[[nodiscard]] double peak_force(const Data& data);

/// The tolerance [N]: the file's share of the peak force, else the usual one; none where every series
/// declares how good its readings are, since what they show then is what the file asks for.
[[nodiscard]] double model_tolerance(const Experiment& experiment, const Data& data);

/// EA and EI whose whole interval is beyond `factor` times those of a solid round section of the declared
/// diameter and modulus. `sure` beyond 1.5 times: a diameter 6 % larger and a modulus 10 % higher give EI 1.4
/// times as large. Nothing where the modulus is not declared.
[[nodiscard]] std::vector<Finding> beyond_construction(const Model& model,
                                                       const std::vector<FittedNumber>& numbers,
                                                       double factor = 1.0);

/// Share of what `base` leaves beside the noise that `final` still leaves, as mean squares; in [0, 1].
[[nodiscard]] double share_left(const Remainder& base, const Remainder& final);

/// Whether what is left is small enough for a partial answer: both limits above. peak: largest force [N].
[[nodiscard]] bool is_partial(const Remainder& base, const Remainder& final, double peak);

/// Whether an effect lowers the error enough to be named, where a size is asked for: by more than a tenth,
/// and by more than the tolerance. before, after: the error; fall: of it or of what is left beside the noise;
/// tolerance, all [N].
[[nodiscard]] bool worth_a_name(double before, double after, double fall, double tolerance);

/// Whether every class has one member: no effect has a rival that the readings cannot tell from it.
[[nodiscard]] bool each_alone(const std::vector<std::vector<std::string>>& classes);

/// What speaks for an answer being the only one.
struct Evidence {
  double dof = 0.0;                                 ///< of the final fit [-]
  std::vector<std::vector<std::string>> classes{};  ///< one a selected effect
  bool cause_outside = false;                       ///< one that the catalogue does not have would do as well
  bool one_condition = false;                       ///< of readings
  bool zero_in_doubt = false;                       ///< of the travel
  bool something_left = false;                      ///< what the noise leaves once in twenty
  bool numbers_open = false;       ///< a null direction of the readings moves a fitted number
  bool readings_in_doubt = false;  ///< their sign or their unit
  /// Errors of conditions left out [N]: of the base model, then with one selected effect after the other.
  std::vector<double> left_out{};
};
/// Classes of one member, five degrees of freedom, nothing left that speaks against it, and conditions left
/// out that every effect predicts better.
[[nodiscard]] bool is_decided(const Evidence& evidence);

}  // namespace snare::identification
