#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "validation/blind_wire.hpp"

namespace snare::validation::blind {

/// A strain as function of its stress resultant and of the unstressed coordinate.
struct Response {
  double strain = 0.0;         ///< kappa [1/m] or e [-]
  double by_stress = 0.0;      ///< d strain/dM or d strain/dN
  double by_coordinate = 0.0;  ///< d strain/dS
};

/// The laws of the section of a blind wire, solved for the strains, with their memory.
///
/// The memory lives on a fixed uniform grid of material points and is interpolated linearly between them,
/// which keeps it within its bounds. An update inverts the law in the material points themselves, so that a
/// memory is never smeared by being interpolated again and again.
class Section {
 public:
  static constexpr std::size_t kFibres = 10;  ///< on either side of the neutral axis

  explicit Section(const BlindWire& wire);

  /// The strains depend on the path.
  [[nodiscard]] bool remembers() const { return strands_ || yields_ || viscous_; }
  [[nodiscard]] bool yields() const { return yields_; }
  [[nodiscard]] bool viscous() const { return viscous_; }

  /// EI with the damage, and its slope. S [m]; [N m^2], [N m]
  [[nodiscard]] std::array<double, 2> stiffness(double S) const;

  /// Curvature from the moment. rate: tau over the time step [-]; guess: a curvature nearby [1/m].
  [[nodiscard]] Response bend(double M, double S, double rate, double guess) const;

  /// Axial strain [-] from the tension N [N] at S [m]; rate as above.
  [[nodiscard]] Response stretch(double N, double S, double rate) const;

  /// Material points [m].
  [[nodiscard]] std::size_t points() const { return remembers() ? count_ : 0; }
  [[nodiscard]] double coordinate(std::size_t j) const { return begin_ + step_ * static_cast<double>(j); }

  /// Stores what material point j has seen: moment [N m] and tension [N] at the end of a step.
  void remember(std::size_t j, double M, double N, double rate);

 private:
  struct Place {
    std::size_t j;
    double part;  ///< of the way to the next one [-]
  };
  [[nodiscard]] Place find(double S) const;
  [[nodiscard]] std::array<double, 2> at(const std::vector<double>& field, Place p) const;
  [[nodiscard]] Response bend_fibres(double M, double S, double rate, double guess) const;

  double bending_;
  double axial_;
  double natural_;
  double damage_from_;
  double damage_to_;
  double damage_;
  double extra_;
  std::vector<double> slip_;  // curvature at which each layer of strands slips [1/m]
  bool strands_;
  bool yields_;
  bool viscous_;
  std::array<double, kFibres> height_{};  // y [m]
  std::array<double, kFibres> area_{};    // of both fibres at +-y [m^2]
  double modulus_ = 0.0;                  // of the plastic share [Pa]
  double limit_ = 0.0;                    // of its stress [Pa]
  double axial_limit_ = 0.0;              // [N]
  double begin_ = 0.0;
  double step_ = 1.0;
  std::size_t count_ = 0;
  std::vector<std::vector<double>> strand_;           // kappa_p, of every layer
  std::vector<std::array<double, kFibres>> plastic_;  // strains
  std::vector<double> axial_plastic_;
  std::vector<double> curvature_;  // at the end of the last step
  std::vector<double> strain_;
};

}  // namespace snare::validation::blind
