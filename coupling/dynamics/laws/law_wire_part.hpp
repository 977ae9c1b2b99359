#pragma once

#include "coupling/dynamics/contact/unilateral_force_part.hpp"
#include "coupling/dynamics/model/law_wire.hpp"

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

namespace snare::coupling {

template <class S>
struct FrameMotion;

/// A wire for which a law stands, in a DAE.                                                  theory.md (M.27)
class LawWirePart final : public UnilateralForcePart {
 public:
  /// Frames on the carriers of its ends, there, and of the shaft.
  LawWirePart(const LawWire& wire, MovingFrame from, MovingFrame to, MovingFrame shaft);

  [[nodiscard]] std::vector<multibody::Wrench> wrenches(const numerics::VectorView& y) const override;
  [[nodiscard]] double depth(const numerics::VectorView& y) const override;
  [[nodiscard]] bool jumps() const override {
    if (wire_.kind == LawWire::Kind::push) return wire_.push_jumps;
    return wire_.kind == LawWire::Kind::rod ? jumps_at_touch(wire_.law) : wire_.axial_time > 0.0;
  }
  [[nodiscard]] Pressing pressing(const numerics::VectorView& y) const override;

  /// What a whole wire would show.
  struct Shape {
    Eigen::Matrix3Xd points;                      ///< mount, where it meets the shaft if it does, mount [m]
    std::array<Eigen::Vector3d, 2> mount_forces;  ///< on the wire's ends [N]
    double tension = 0.0;                         ///< [N], >= 0
  };
  /// At unknowns y of the run (SI units).
  [[nodiscard]] Shape shape(const numerics::VectorView& y) const;

  /// Looks whether the shaft is within reach, and before the wire; to be told the start, y in SI units.
  void update_candidates(const numerics::VectorView& y) override;
  void accept(const numerics::DaePoint& at) override { update_candidates(at.y); }
  [[nodiscard]] double let_go() const override { return let_go_; }
  void save_state(std::vector<double>& memory) const override;
  void restore_state(const numerics::VectorView& y, std::span<const double>& memory) override;

 private:
  template <class S>
  struct Action;
  template <class S>
  struct Stop;
  [[nodiscard]] Eigen::MatrixXd derivatives(const numerics::VectorView& y) const override;
  template <class S>
  [[nodiscard]] Action<S> act(const std::array<FrameMotion<S>, 3>& frames) const;
  template <class S>
  [[nodiscard]] Action<S> stretched(const std::array<FrameMotion<S>, 3>& frames) const;
  template <class S>
  [[nodiscard]] Stop<S> stop(const std::array<FrameMotion<S>, 3>& frames, std::size_t mount,
                             Action<S>& a) const;
  template <class S>
  [[nodiscard]] Action<S> rod(const std::array<FrameMotion<S>, 3>& frames) const;
  template <class S>
  [[nodiscard]] Action<S> push(const std::array<FrameMotion<S>, 3>& frames) const;
  [[nodiscard]] bool reaches(const std::array<FrameMotion<double>, 3>& frames) const;
  [[nodiscard]] Action<double> now(const numerics::VectorView& y) const;

  LawWire wire_;
  Eigen::Vector3d binormal_;  // of bulge and chord, in the axes of the frame at `from`
  double stop_stiffness_;     // of a mount against the shaft [N/m]
  ContactLaw stop_;
  bool within_ = false;  // the shaft is within reach along its axis
  bool holds_ = false;   // and was before the wire when it came there
  double let_go_ = 0.0;  // [J], see let_go()
  double angle_ = 0.0;  // of a string between its mounts as seen from the axis of the shaft, at the last step
};

}  // namespace snare::coupling
