#include "coupling/dynamics/joints/carried_wire.hpp"

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d CarriedWire::velocity(int vertex, const VectorXd& y) const {
  const Vector3d x = y.segment<3>(rod->position_of(vertex));
  const auto rigid = [&x](const MovingFrame::State& s) -> Vector3d {
    return s.linear + s.angular.cross(x - s.X_WF.p);
  };
  const double share = rod->coordinate(vertex) / rod->constants().length;
  return (1.0 - share) * rigid(carriers[0]) + share * rigid(carriers[1]);
}

double CarriedWire::twist_rate(int edge, const VectorXd& y) const {
  const Vector3d tangent =
      Vector3d(y.segment<3>(rod->position_of(edge + 1)) - y.segment<3>(rod->position_of(edge))).normalized();
  const double share = 0.5 * (rod->coordinate(edge) + rod->coordinate(edge + 1)) / rod->constants().length;
  return tangent.dot((1.0 - share) * carriers[0].angular + share * carriers[1].angular);
}

}  // namespace snare::coupling
