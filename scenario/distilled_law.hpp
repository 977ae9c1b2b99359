#pragma once

#include "coupling/contact/force_table.hpp"
#include "coupling/contact/law_form.hpp"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace snare::scenario {

/// A simple law of law.json at one position, with its numbers.
struct SimpleLaw {
  double position = 0.0;  ///< s [m]
  std::string name, formula;
  std::vector<coupling::LawParameter> parameters;
  std::vector<double> values;      ///< in SI, one a parameter
  std::array<double, 2> travel{};  ///< from, to: where it was fitted [m]
  double largest_error = 0.0;      ///< against the full wire over these travels [N]
  coupling::SpringLawPointer law;
};

/// The wire of which a law was distilled, and what pushed it. SI units.
struct DistilledWire {
  double bending_stiffness = 0.0;  ///< EI [N m^2]
  double axial_stiffness = 0.0;    ///< EA [N]
  double span = 0.0;               ///< [m]
  double radius = 0.0;             ///< of the pusher [m]
};

/// What a law.json says of one wire, ready to be evaluated. Lengths in m, forces in N.
struct DistilledLaw {
  std::string title;
  std::shared_ptr<const coupling::ForceTable> loading;    ///< never null
  std::shared_ptr<const coupling::ForceTable> unloading;  ///< from the end of the travel; null where nothing dissipates
  double bound = 0.0;                                     ///< stated error of the table [N]
  double force_range = 0.0;                               ///< of the full wire over the range [N]
  std::array<double, 2> travel{}, position{}, slack{};    ///< from, to [m]
  double nominal_slack = 0.0;                             ///< length less span [m]
  std::vector<SimpleLaw> simple;
  DistilledWire wire;

  /// Whether the range of the table has travel d, position s and slack e [m]; slack counts as met to 1e-9 of the span.
  [[nodiscard]] bool in_range(double d, double s, double e) const noexcept;
  /// Force [N] at travel d, position s and slack e [m] of `table`, one of the two above; no contact (d < 0): 0. The same number
  /// as ForceTable::at gives, in half the time. Throws std::domain_error as that does, and for a number that is not finite.
  [[nodiscard]] double force(const coupling::ForceTable& table, double d, double s, double e,
                             coupling::Outside outside) const;
  /// dF/dd [N/m], likewise.
  [[nodiscard]] double stiffness(const coupling::ForceTable& table, double d, double s, double e,
                                 coupling::Outside outside) const;
};

/// Reads a law.json: one law a case. Throws base::InputError for a file that is none, naming the field.
///                                                                                           docs/law_json.md
[[nodiscard]] std::vector<DistilledLaw> read_law_file(const std::filesystem::path& file);
/// The same from a document in memory; `name` stands in messages.
[[nodiscard]] std::vector<DistilledLaw> read_laws(const std::string& name, const nlohmann::json& document);

}  // namespace snare::scenario
