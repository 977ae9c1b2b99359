#pragma once

#include "coupling/dynamics/joints/body_part.hpp"
#include "multibody/arm/arm_part.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::coupling {

/// A frame that a body, an arm or the world carries, as constraints see it.                  theory.md (M.15)
///
/// Its place depends on the unknowns `coordinates()`, its motion on these and on `velocities()`; the rows of
/// the same index as the velocities are the balances of force to which a wrench on the frame adds -J^T F. A
/// body that is driven has coordinates but no rows.
class MovingFrame {
 public:
  /// Fixed in the world.
  explicit MovingFrame(const multibody::Pose& X_WF) : X_CF_(X_WF) {}
  MovingFrame(const BodyPart& body, const multibody::Pose& X_BF) : body_(&body), X_CF_(X_BF) {}
  /// X_BF: in the frame of a body of the arm's tree; body -1: the world.
  MovingFrame(const multibody::ElasticArmPart& arm, int body, const multibody::Pose& X_BF);

  /// An axis of the joints that bear a body of a tree.
  struct ChainAxis {
    int velocity = 0;  ///< its index, and that of its column (s, v) in J
    int depth = 0;     ///< of its joint in the chain: 0 at the body, less towards the root
  };
  /// Pose in the world, angular velocity [rad/s], and velocity of the origin [m/s], in the axes of the world.
  struct State {
    multibody::Pose X_WF;
    Eigen::Vector3d angular = Eigen::Vector3d::Zero();
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  };
  /// At unknowns y of the run (SI units).
  [[nodiscard]] State state(const numerics::VectorView& y) const;

  /// Derivatives at one y (SI units), angular over linear, in the axes of the world.
  class Derivatives {
   public:
    multibody::Matrix6X jacobian;  ///< motion by velocities: J
    multibody::Matrix6X place;     ///< turn and shift by coordinates
    multibody::Matrix6X motion;    ///< motion by coordinates
    /// (columns of the jacobian x coordinates): derivative of J^T F for a wrench that is fixed in the world,
    /// by M and F.
    [[nodiscard]] Eigen::MatrixXd force(const multibody::Wrench& wrench) const;

   private:
    friend class MovingFrame;
    /// Calls `each(i, j, change)` with the change of column i of J when j moves: an axis of the arm, or a
    /// component of the quaternion.
    template <class Each>
    void for_changes(const Each& each) const;
    void add_motion(const Eigen::Ref<const Eigen::VectorXd>& velocities);
    [[nodiscard]] bool of_arm() const { return to_motion_.size() > 0; }

    std::vector<ChainAxis> chain_;  // of an arm
    Eigen::MatrixXd to_motion_;  // (velocities x coordinates) of an arm: motions of its joints by coordinates
    Eigen::Matrix<double, 3, 4> turn_{};  // of a body: its turn by the quaternion
    int first_turning_ = 0,
        spin_ = 0;  // of a body: the quaternion among coordinates, the spin among velocities
  };
  /// At unknowns y of the run (SI units).
  [[nodiscard]] Derivatives differentiate(const numerics::VectorView& y) const;
  /// J alone, (6, velocities); y in SI units.
  [[nodiscard]] multibody::Matrix6X jacobian(const numerics::VectorView& y) const;

  /// Indices of the unknowns on which the frame's place depends, and of those on which its motion depends
  /// besides.
  [[nodiscard]] std::vector<int> coordinates() const;
  [[nodiscard]] std::vector<int> velocities() const;
  /// Whether forces on it move it.
  [[nodiscard]] bool moves_freely() const;
  /// Adds -J^T F [N m, N] to the rows of whoever carries it; the first without a Jacobian.
  void push(const numerics::VectorView& y, const multibody::Wrench& wrench,
            Eigen::Ref<Eigen::VectorXd> rows) const;
  void push(const multibody::Matrix6X& jacobian, const multibody::Wrench& wrench,
            Eigen::Ref<Eigen::VectorXd> rows) const;
  /// Adds M^-1 J^T F, what the wrench does to the velocities (or accelerations) of its carrier, in SI units.
  void apply_impulse(const numerics::VectorView& y, const multibody::Matrix6X& jacobian,
                     const multibody::Wrench& wrench, Eigen::VectorXd& dv) const;
  [[nodiscard]] const BodyPart* body() const { return body_; }
  [[nodiscard]] const multibody::ElasticArmPart* arm() const { return arm_; }

 private:
  const BodyPart* body_ = nullptr;
  const multibody::ElasticArmPart* arm_ = nullptr;
  int tree_body_ = -1;
  multibody::Pose X_CF_;
};

}  // namespace snare::coupling
