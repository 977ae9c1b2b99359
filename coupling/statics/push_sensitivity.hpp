#pragma once

#include "coupling/statics/push_options.hpp"
#include "coupling/statics/push_problem.hpp"
#include "coupling/statics/push_system.hpp"
#include "numerics/path.hpp"

#include <array>
#include <map>
#include <memory>
#include <vector>

namespace snare::coupling {

/// Derivatives of a path of equilibria by numbers p of its test, by implicit differentiation.
///                                                                                           theory.md (C.13)
///
///   F(z, h, t; p) = 0:  J dz/dp = -(dF/dp + dF/dh dh/dp + dF/dt dt/dp)
///
/// z: the unknowns, J the factorised Jacobian of Newton's method, h: what friction remembers (material
/// coordinates, directions) and what the sliders of the sections do, t: the travel. The right-hand side is
/// the central difference of the residual at fixed z, in which the numbers enter by elementary functions;
/// dh/dp is carried along from accepted point to accepted point.
class PushSensitivity {
 public:
  /// mesh: that of the system whose path is differentiated.
  PushSensitivity(const PushProblem& test, const wire::MaterialMesh& mesh,
                  const std::vector<PushVariation>& variations);

  /// At the first touch, the system in the state in which that was found (see prepare_push).
  void begin(PushSystem& system, const numerics::PathPoint& at, numerics::PathWorkspace& workspace);

  /// The system has carried the slips of its sections, `before`, over to other vertices in a step to `travel`
  /// [m]: so are their derivatives.
  void carry_sections(const wire::SectionMemory& before, const PushSystem& system, double travel);

  /// At a converged point, before the system forgets the point that friction remembered. Leaves the point's
  /// factorisation in the workspace.
  void advance(PushSystem& system, const numerics::PathPoint& at, numerics::PathWorkspace& workspace);

  /// Derivatives of what friction remembers.
  struct Memory {
    std::vector<double> coordinate;  // of the sliding contacts [m]
    std::vector<double> angle;       // of their last tangents [rad]
    std::map<int, double> radial;    // angle of the last radial of a wrapped vertex [rad]
    std::vector<double> mounts;      // of `last` of the mounts that can slip [m]
    std::vector<double> bending;     // slipped curvatures of the sliders [1/m]
    std::vector<double> axial;       // slipped strains [-]
    wire::Controls moved{};          // of the controls by the carrying of the slips since the last point [m]
    wire::Controls rate{};           // of the drift's rate [-]
    numerics::PathPoint change;      // of the unknowns, and of the travel
  };
  /// What is carried from point to point, to be put aside and given to `restore` where steps are taken back.
  struct Memories {
    std::vector<Memory> of_variations;
    std::vector<double> force_by;
  };
  [[nodiscard]] Memories memories() const;
  void restore(const Memories& memories);

  /// The same at first touch, where the wire settles: the travel counts from there and does not change with
  /// its zero.
  void advance_at_touch(PushSystem& system, const numerics::PathPoint& at,
                        numerics::PathWorkspace& workspace);

  /// d force / d p at the point of the last advance(), one a variation: [N] over the SI unit of its number.
  [[nodiscard]] const std::vector<double>& force_by() const { return force_by_; }

 private:
  /// The test changed by one step forth or back.
  struct Side {
    double amount = 0.0;
    std::unique_ptr<wire::PlanarRod> rod;
    std::unique_ptr<PushSystem> system;
    std::vector<SlidingContact> contacts;  // constants
    wire::Controls controls{};             // to begin with
    std::vector<SlippingMount> mounts;     // constants
  };
  struct Varied {
    std::array<Side, 2> sides;  // minus, plus
    double step = 0.0;
    double travel = 0.0;
    std::array<double, 2> mount_compliance{};  // left, right
    Eigen::VectorXd held;                      // d(positions that the mounts hold)/dp
    std::vector<Eigen::Vector2d> centre;       // d(centre of the sliding contacts)/dp
    Memory memory;
  };

  void put_states(const PushSystem& system, Varied& varied, Side& side) const;
  [[nodiscard]] static wire::Controls controls_by(const PushSystem& system, const Varied& varied);
  void put_sections(const wire::SectionMemory& sections, const PushSystem& system, const Varied& varied,
                    Side& side) const;
  [[nodiscard]] numerics::PathPoint solve(const PushSystem& system, const numerics::PathPoint& at,
                                          numerics::PathWorkspace& workspace, Varied& varied);
  void remember(const PushSystem& system, const numerics::PathPoint& at, const numerics::PathPoint& change,
                Varied& varied) const;

  std::vector<Varied> varied_;
  std::vector<double> force_by_;
  numerics::BorderedSystem scratch_;
  Eigen::VectorXd by_parameter_;
};

}  // namespace snare::coupling
