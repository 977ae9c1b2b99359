#pragma once

#include "coupling/contact/force_table.hpp"
#include "coupling/contact/law_form.hpp"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace snare::scenario {

/// A simple law of law.json at one position, with its numbers.
struct SimpleLaw {
  double position = 0.0;     ///< s [m]
  coupling::LawPlace place;  ///< of the wire
  std::string name, formula;
  std::vector<coupling::LawParameter> parameters;
  std::vector<double> values;      ///< in SI, one a parameter
  std::array<double, 2> travel{};  ///< from, to: where it was fitted [m]
  double largest_error = 0.0;      ///< against the full wire over these travels [N]
  coupling::SpringLawPointer law;  ///< never negative, linear beyond these travels
};

/// The law of this name at a place with numbers in the order of its form's parameters, over the travels up to
/// `end` [m]; its name must be known, and the numbers as many as its parameters.
[[nodiscard]] SimpleLaw make_simple_law(const std::string& name, const coupling::LawPlace& place,
                                        std::vector<double> values, std::array<double, 2> travel);
/// The parameters of the law of this name; none where no law has it.
[[nodiscard]] std::vector<coupling::LawParameter> parameters_of_law(const std::string& name);

/// Energy that a wire loses at one position, as law.json states it. SI units.
struct DistilledLoss {
  double position = 0.0;  ///< s [m]
  /// Load/unload law (theory.md, R.9): share of the loading force that is left on the way back [-], travel of
  /// a turn [m], energy of one loop over the whole travel [J].
  struct Loop {
    double returned = 1.0, turn = 0.0, energy = 0.0;
  };
  std::optional<Loop> loop;  ///< where friction or strands dissipate
  /// Dashpot of the first impact in the file that has one (theory.md, R.11).
  struct Dashpot {
    double speed = 0.0, restitution = 1.0, damping = 0.0;  ///< of approach [m/s], [-], c [N s/m]
  };
  std::optional<Dashpot> dashpot;
};

/// The wire of which a law was distilled, and what pushed it. SI units.
struct DistilledWire {
  double bending_stiffness = 0.0;  ///< EI [N m^2]
  double axial_stiffness = 0.0;    ///< EA [N]
  double span = 0.0;               ///< [m]
  double radius = 0.0;             ///< of the pusher [m]
};

/// A force [N], and whether it is the continuation of a law outside its range.
struct ContinuedForce {
  double force = 0.0;
  bool extrapolated = false;
};

/// What a law.json says of one wire, ready to be evaluated. Lengths in m, forces in N.
struct DistilledLaw {
  std::string title;
  std::shared_ptr<const coupling::ForceTable> loading;  ///< never null
  std::shared_ptr<const coupling::ForceTable>
      unloading;             ///< from the end of the travel; null where nothing dissipates
  double bound = 0.0;        ///< stated error of the table [N]
  double force_range = 0.0;  ///< of the full wire over the range [N]
  std::array<double, 2> travel{}, position{}, slack{};  ///< from, to [m]
  double nominal_slack = 0.0;                           ///< length less span [m]
  std::vector<SimpleLaw> simple;
  std::vector<DistilledLoss> losses;  ///< one a law position, in the order of the file
  DistilledWire wire;

  /// Whether the force at travel d, position s and slack e [m] needs no continuation: within the range of the
  /// table, to 1e-9 of the span, or without contact (d < 0).
  [[nodiscard]] bool in_range(double d, double s, double e) const noexcept;
  /// Force and stiffness at travel d, position s and slack e [m] of `table`, one of the two above:
  /// ForceTable::at. Throws std::domain_error as that does, and for a number that is not finite.
  [[nodiscard]] static coupling::LawValue at(const coupling::ForceTable& table, double d, double s, double e,
                                             coupling::Outside outside);
  /// The same force [N] in half the time.
  [[nodiscard]] static ContinuedForce force(const coupling::ForceTable& table, double d, double s, double e,
                                            coupling::Outside outside);
};

/// Reads a law.json: one law a case. Throws base::InputError for a file that is none, naming the field.
///                                                                                           docs/law_json.md
[[nodiscard]] std::vector<DistilledLaw> read_law_file(const std::filesystem::path& file);
/// The same from a document in memory; `name` stands in messages.
[[nodiscard]] std::vector<DistilledLaw> read_laws(const std::string& name, const nlohmann::json& document);

}  // namespace snare::scenario
