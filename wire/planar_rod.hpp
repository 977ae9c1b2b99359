#pragma once

#include "numerics/band_matrix.hpp"
#include "wire/mesh.hpp"
#include "wire/section_law.hpp"

#include <Eigen/Core>

#include <array>
#include <limits>
#include <vector>

namespace snare::wire {

/// How a mount holds one end of a planar rod.
struct PlanarEnd {
  enum class Kind {
    clamp,  ///< position and direction
    pin,    ///< position, free to turn
    free    ///< neither (something else holds it, e.g. a support that it slides over)
  };
  Kind kind = Kind::clamp;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();    ///< [m]
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< of increasing arc length; unit
  /// Of a clamp that gives [N m/rad], > 0.
  double rotational_stiffness = std::numeric_limits<double>::infinity();
  /// Along the chord, of a mount that gives [N/m], > 0.
  double translational_stiffness = std::numeric_limits<double>::infinity();
};

/// Constants of a planar rod.
struct PlanarRodProperties {
  /// EI [N m^2], > 0; beside `bending_sliders` the part that is elastic for good.
  double bending_stiffness = 0.0;
  double axial_stiffness = 0.0;                ///< EA [N], > 0; likewise
  std::vector<SliderElement> bending_sliders;  ///< on curvature less the natural one
  std::vector<SliderElement> axial_sliders;    ///< on the axial strain
  /// Factor of EI along the wire: at stations evenly spread over the material between the mounts, linear
  /// between; empty: uniform. Each > 0.
  std::vector<double> bending_profile;
  double natural_curvature = 0.0;                    ///< [1/m], positive for turning left along the wire
  Eigen::Vector2d weight = Eigen::Vector2d::Zero();  ///< force per unstretched length [N/m]
  PlanarEnd left;
  PlanarEnd right;
};

/// Unknowns of the planar rod: q = (x_0, y_0, x_1, y_1, ...) [m], and what carries the mesh.
struct PlanarState {
  Eigen::VectorXd q;
  Controls controls{};
  const SectionMemory* memory = nullptr;  ///< of the sliders; null: virgin
};

/// Energy and derivatives at one state. `hessian` is by q; `control_columns[k]` = d gradient / d control k is
/// filled for the controls asked for.
struct RodAssembly {
  double energy = 0.0;       ///< [J]
  Eigen::VectorXd gradient;  ///< dE/dq, rows of held unknowns included [N]
  numerics::SymmetricBandMatrix hessian;
  std::array<Eigen::VectorXd, 3> control_columns;
  Eigen::Vector3d control_gradient = Eigen::Vector3d::Zero();  ///< dE/dS_k, all three [N]
  Eigen::Matrix3d control_hessian = Eigen::Matrix3d::Zero();   ///< d2E/dS_k dS_l [N/m]
};

/// The discrete elastic rod in its plane.                     theory.md (W.1)-(W.9); Bergou et al. 2008, 2010
///
///   E = sum_edges 1/2 EA (l/l0 - 1)^2 l0 + sum_vertices 1/2 k_i (kappa_i - kappa_nat l_i)^2 - sum w.x m
///
/// with the integrated curvature kappa_i = 2 tan(phi_i/2) of the turning angle phi_i, l_i half of the two
/// rest lengths beside the vertex, k_i = EI/l_i. A clamp is the vertex at the mount with the mount's
/// direction as its outer edge and half a cell, l_0/2, so that force and moment converge at second order; a
/// clamp that gives has k_0 in series with its rotational stiffness. With sliders the energies are those of
/// respond(), strain kappa_i / l_i - kappa_nat at vertices (sliders do not slip in the half cell of a clamp
/// that gives) and l/l0 - 1 at edges.
class PlanarRod {
 public:
  static constexpr int dimension = 2;
  static constexpr int block = 2;           ///< unknowns a vertex
  static constexpr int half_bandwidth = 5;  ///< x_i and y_{i+2}

  PlanarRod(MaterialMesh mesh, const PlanarRodProperties& properties);

  /// The mesh that the state's controls carry.
  [[nodiscard]] const MaterialMesh& mesh() const noexcept { return mesh_; }
  /// The constants that it was made with.
  [[nodiscard]] const PlanarRodProperties& properties() const noexcept { return properties_; }
  /// Number of unknowns q, held ones with them.
  [[nodiscard]] int unknowns() const noexcept { return block * mesh_.vertices(); }

  /// Energy [J] alone.
  [[nodiscard]] double energy(const PlanarState& state) const;

  /// Everything at once into `out`, whose storage is reused. wanted[k]: fill control_columns[k]. Springs of
  /// the mounts are in; rigidly held unknowns are not yet applied, so that the gradient there is the
  /// reaction: see `hold_mounts`.
  void assemble(const PlanarState& state, const std::array<bool, 3>& wanted, RodAssembly& out) const;

  /// Holds the rigid positions: gradient entries of held unknowns become zero, their rows and columns those
  /// of the identity.
  void hold_mounts(RodAssembly& assembly) const;

  /// Makes the entries of held unknowns zero; band: of any unit.
  void clear_held(Eigen::VectorXd& band) const;

  /// Turning moment M_i at the vertices [N m], positive for turning left; the end values belong to the
  /// mounts.
  [[nodiscard]] Eigen::VectorXd moments(const PlanarState& state) const;
  /// Axial force of every edge [N], tension positive.
  [[nodiscard]] Eigen::VectorXd tensions(const PlanarState& state) const;
  /// Bending stiffness times integrated curvature rates and axial stiffness times strain rates: for a rate
  /// dq/dt of the state the quadratic form sum EA (de)^2 l0 + sum k_i (dkappa_i)^2 of the elastic springs
  /// [J/s^2].
  ///                                                                                         theory.md (W.14)
  [[nodiscard]] double rate_form(const PlanarState& state, const PlanarState& rate) const;

  /// Whether it has sliders, so that forces depend on the path.
  [[nodiscard]] bool has_memory() const noexcept {
    return !properties_.bending_sliders.empty() || !properties_.axial_sliders.empty();
  }
  /// The memory after the sliders have followed to this state.
  [[nodiscard]] SectionMemory remembered(const PlanarState& state) const;

 private:
  MaterialMesh mesh_;
  PlanarRodProperties properties_;
};

/// Adds a step [m] to the unknowns. (The spatial rod transports its frames here as well.)
inline void advance(PlanarState& state, const Eigen::VectorXd& step) {
  state.q += step;
}

/// Position of vertex i [m].
[[nodiscard]] inline Eigen::Vector2d vertex(const PlanarState& state, int i) {
  return state.q.segment<2>(2 * i);
}

}  // namespace snare::wire
