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
  /// `drawn`: what carriers take along; empty: the shapes of the motion's contacts. The motion and the samples must outlive this.
  MotionPictures(const coupling::Motion& motion, const std::vector<coupling::MotionSample>& samples,
                 std::vector<scenario::DrawnLines> drawn);

  /// To be turned by the reader; `marks` are times at which something happened.
  [[nodiscard]] SceneSpecification scene(std::vector<SceneMark> marks) const;

  /// The wires, then what carriers take along.
  [[nodiscard]] std::vector<ParaviewFrame> paraview() const;

 private:
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
