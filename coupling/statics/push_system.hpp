#pragma once

#include "coupling/contact/pin_contact.hpp"
#include "numerics/path.hpp"
#include "wire/planar_rod.hpp"
#include "wire/specification.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace snare::coupling {

/// A mount that lets the wire through, or slides with it, when the force on it passes Coulomb's limit.
/// theory.md (C.8) Its unknown in the border is the material coordinate that it holds, S [m], or the force of
/// its friction on the wire along the chord [N].
struct SlippingMount {
  bool right = false;  ///< else the left one
  wire::MountSlip kind = wire::MountSlip::feeds;
  double limit = 0.0;       ///< driving force at which it slips [N], > 0
  double compliance = 0.0;  ///< of a spring between a mount that slides and what it slides on [m/N], >= 0
  /// Brings in as much wire as the mount before it, and has no equation of its own: where the wire slides
  /// freely over the pusher the driving forces of both are equal whatever share each has.
  bool follows = false;
  bool slips = false;
  double slip_sign = 0.0;   ///< of the driving force while it slips, +1: the wire pulls, or -1 [-]
  double last = 0.0;        ///< S, or where the mount stands along the chord, at the last accepted state [m]
  double last_drive = 0.0;  ///< driving force there [N]

  /// The wire slips through it; else it slides with the wire.
  [[nodiscard]] bool feeds() const { return kind == wire::MountSlip::feeds; }
  [[nodiscard]] int control() const { return right ? 2 : 0; }        ///< that a feeding mount moves
  [[nodiscard]] double sense() const { return right ? -1.0 : 1.0; }  ///< of the chord from this mount inwards
  /// Slipped since the last state, > 0 where wire comes in [m]. now: S, or where the mount stands.
  [[nodiscard]] double moved(double now) const { return (feeds() ? -sense() : sense()) * (now - last); }
};

/// The mounts that slip, as they begin. friction: at the pusher [-].
[[nodiscard]] std::vector<SlippingMount> slipping_mounts(const wire::MountSpecification& mount,
                                                         double friction, const wire::Controls& controls);

/// The material that the vertices stand for, and how fast it changes along the path.
struct Drift {
  wire::Controls controls{};  ///< at the last accepted point [m]
  double travel = 0.0;        ///< there [m]
  wire::Controls rate{};      ///< by the travel, over the last step [-]
};

/// Contacts and mount of a push, with what they remember of the last accepted state.
struct ContactStates {
  std::vector<SlidingContact> sliding;  ///< the pusher first, then the supports
  std::vector<WrappedContact> wrapped;
  std::vector<SlippingMount> mounts;  ///< that can slip
  wire::SectionMemory sections;       ///< of a wire with sliders
  Drift drift;                        ///< of a wire with sliders
};

/// Places of a sliding contact in the border: of its unknowns (columns), and of its equations (rows).
struct SlidingRows {
  static constexpr int count = 4;
  explicit SlidingRows(int first)
      : force(first),
        coordinate(first + 2),
        gap(first + 3),
        position(first),
        slip(first + 2),
        closure(first + 3) {}

  int force;       ///< f_x, f_y: force on the wire [N]
  int coordinate;  ///< S: material coordinate of the vertex [m]
  int gap;         ///< g [m]

  int position;  ///< x - p - (R + g) n = 0, two rows                     theory.md (C.2)
  int slip;      ///< sticks, slides, or keeps its material point         theory.md (C.4), (C.5)
  int closure;   ///< g = 0. A contact apart has f = 0 in `slip` and here.  theory.md (C.3)
};

/// The same of a vertex that lies on the pusher.                            theory.md (C.7)
struct WrappedRows {
  static constexpr int count = 2;
  explicit WrappedRows(int first) : force(first), distance(first), slip(first + 1) {}

  int force;  ///< f_x, f_y [N]

  int distance;  ///< |x - p| - R = 0
  int slip;      ///< sticks or slides along the pusher
};

/// Equilibrium of a planar rod with the pins that guide it, as a path problem in the pusher's travel.
///
/// Band unknowns: q of the rod. Border unknowns: of every sliding contact (f_x, f_y, S, g), see SlidingRows;
/// of every wrapped one (f_x, f_y); of every mount that can slip one, see SlippingMount.
class PushSystem final : public numerics::PathProblem, public ContactStates {
 public:
  PushSystem(const wire::PlanarRod& rod, const wire::Controls& controls);

  double compliance = 0.0;  ///< of the pusher along its motion [m/N], >= 0

  /// What contacts and mount remember: to be put aside and given to `restore` where a step is taken back.
  [[nodiscard]] const ContactStates& contact_states() const { return *this; }
  /// Puts back what `contact_states` gave.
  void restore(const ContactStates& states) { static_cast<ContactStates&>(*this) = states; }

  /// Carries the slips of the sections over to the vertices at which their material will be at `travel` [m],
  /// at the rate of the last step; or at which other controls put it.
  void carry_sections(double travel);
  void carry_sections(const wire::Controls& to);
  /// Keeps the controls of an accepted point [m], at its travel [m], and their rate unless the step to it was
  /// too short for one.
  void follow_drift(const wire::Controls& controls, double travel);
  /// Whether a step of the travel [m] is long enough for a rate: in a shorter one that would be round-off.
  [[nodiscard]] bool has_rate(double step) const { return std::abs(step) > 1e-5 * length_; }

  /// Columns of the border: unknowns of all contacts, and one of every mount that can slip.
  [[nodiscard]] int border_unknowns() const;
  /// Places in the border of the contact's unknowns and equations, counted as in `sliding`; of the pusher; of
  /// one in `wrapped`.
  [[nodiscard]] SlidingRows sliding_rows(std::size_t contact) const {
    return SlidingRows(SlidingRows::count * static_cast<int>(contact));
  }
  [[nodiscard]] SlidingRows pusher_rows() const { return sliding_rows(0); }
  [[nodiscard]] WrappedRows wrapped_rows(std::size_t contact) const;
  /// Of a mount's unknown, and of its equation; counted as in `mounts`.
  [[nodiscard]] int mount_row(std::size_t k) const {
    return wrapped_rows(wrapped.size()).force + static_cast<int>(k);
  }
  /// Force that drives the mount, > 0 where the wire pulls [N], and S or where it stands [m]; of the last
  /// assembly.
  [[nodiscard]] double mount_drive(std::size_t k, const numerics::PathPoint& at) const;
  [[nodiscard]] double mount_place(std::size_t k, const numerics::PathPoint& at) const;
  /// The rod with mounts that slide held where they are.
  [[nodiscard]] wire::PlanarRod rod_with_held_mounts(const numerics::PathPoint& at) const;

  /// The rod that is pushed.
  [[nodiscard]] const wire::PlanarRod& rod() const { return *rod_; }
  /// Place of the pusher's axis [m]: centre + (parameter - compliance F) motion, F its force along the motion
  /// [N].
  [[nodiscard]] Eigen::Vector2d pusher_centre(const numerics::PathPoint& at) const;
  /// Force of the pusher on the wire [N].
  [[nodiscard]] Eigen::Vector2d pusher_force(const numerics::PathPoint& at) const;
  /// The rod's state at a point of the path.
  [[nodiscard]] wire::PlanarState state(const numerics::PathPoint& at) const;
  [[nodiscard]] VertexTangent tangent_at(const SlidingContact& contact, const wire::PlanarState& state) const;

  /// PathProblem: equilibrium of the rod under f of every contact, and the equations in SlidingRows and
  /// WrappedRows.
  ///                                                                                    theory.md (C.2)-(C.8)
  void assemble(const numerics::PathPoint& at, numerics::BorderedSystem& system,
                Eigen::VectorXd& by_parameter) override;
  /// Of assemble() the residuals [N], [m] alone; matrices of the system are of no use then.
  void assemble_residual(const numerics::PathPoint& at, numerics::BorderedSystem& system,
                         Eigen::VectorXd& by_parameter);
  [[nodiscard]] double error(const numerics::PathPoint& at,
                             const numerics::BorderedSystem& system) const override;
  [[nodiscard]] double length_scale() const override { return length_; }

  /// Reactions of the mounts on the wire at the last assembly: left, right [N].
  [[nodiscard]] const std::array<Eigen::Vector2d, 2>& mount_reactions() const { return reactions_; }
  /// Energy of the rod at the last assembly [J] and its derivatives by the controls.
  [[nodiscard]] const wire::RodAssembly& rod_assembly() const { return assembly_; }

 private:
  void add_contacts(const wire::PlanarState& state, const numerics::PathPoint& at,
                    numerics::BorderedSystem& system, Eigen::VectorXd& by_parameter);
  void take_reactions(const wire::PlanarState& state, const numerics::PathPoint& at);
  void assemble_sliding(std::size_t index, const wire::PlanarState& state, const numerics::PathPoint& at,
                        numerics::BorderedSystem& system, Eigen::VectorXd& by_parameter) const;
  void assemble_wrapped(std::size_t index, const wire::PlanarState& state, const numerics::PathPoint& at,
                        numerics::BorderedSystem& system, Eigen::VectorXd& by_parameter) const;
  void add_compliance(int row, const Eigen::Vector2d& by_centre, numerics::BorderedSystem& system) const;
  void assemble_mount(std::size_t index, const numerics::PathPoint& at,
                      numerics::BorderedSystem& system) const;
  /// Place in the band of a mount's position along the chord.
  [[nodiscard]] int band_of(const SlippingMount& mount) const {
    return mount.right ? 2 * rod_->mesh().edges() : 0;
  }

  const wire::PlanarRod* rod_;
  wire::Controls controls_;
  double length_;
  double shortest_edge_;
  wire::RodAssembly assembly_;  // workspace of assemble(); the system's dense columns point into it
  std::array<Eigen::Vector2d, 2> reactions_{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
};

}  // namespace snare::coupling
