#pragma once

#include "app/report/paraview.hpp"
#include "app/report/report_page.hpp"
#include "scenario/world.hpp"

#include <string>
#include <vector>

namespace snare::app {

/// Pictures of a motion: wires, bodies, shapes, rings, and arms from joint to joint.
class MotionPictures {
 public:
  /// `drawn`: what carriers take along; empty: the shapes of the motion's contacts. The motion and the
  /// samples must outlive this.
  MotionPictures(const coupling::Motion& motion, const std::vector<coupling::MotionSample>& samples,
                 std::vector<scenario::DrawnLines> drawn);

  /// To be turned by the reader; `marks` are times at which something happened.
  [[nodiscard]] SceneSpecification scene(std::vector<SceneMark> marks) const;

  /// The wires, the shapes on carriers, the arms. Velocities of rods and bodies are those of the motion;
  /// velocities of arms and of law wires are differences of the samples.
  [[nodiscard]] std::vector<ParaviewFrame> paraview() const;

 private:
  [[nodiscard]] std::vector<ParaviewLine> wire_lines(const coupling::MotionSample& s) const;
  /// Forces of all contacts on the wires, shared out to their points.
  void add_contact_forces(const coupling::MotionSample& s, std::vector<ParaviewLine>& lines) const;
  struct Carried {
    std::string name;
    coupling::MotionCarrier carrier;
    std::vector<Eigen::Matrix3Xd> lines;  ///< in the carrier's frame [m]
  };
  class Moment;

  const coupling::Motion& motion_;
  const std::vector<coupling::MotionSample>& samples_;
  std::vector<Carried> carried_;
};

}  // namespace snare::app
