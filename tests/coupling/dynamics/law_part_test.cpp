#include "coupling/dynamics/laws/law_part.hpp"

#include "tests/support/sparse_product.hpp"

#include <gtest/gtest.h>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

TEST(LawPart, JacobianMatchesDifferences) {
  MotionBody body;
  body.properties.inertia = Vector3d(0.2, 0.3, 0.4).asDiagonal();
  const MotionOptions options;
  BodyPart part(body, Vector3d::Zero(), options);
  PointContactLaw spring;
  spring.point = {0.05, 0.1, -0.02};
  spring.origin = {0.0, 0.05, 0.0};
  spring.direction = Vector3d(0.2, 0.9, 0.1).normalized();
  spring.law = power_law(3e3, 1.5, 200.0, 1.0);
  LawPart law(spring, part);
  numerics::DaeSystem system({&part, &law});
  VectorXd y = VectorXd::Zero(system.size());
  part.place(y);
  y.segment<4>(part.quaternion()) = Eigen::Vector4d(0.98, 0.1, -0.12, 0.11).normalized();
  y.segment<3>(part.velocity()) << 0.1, 0.3, -0.1;
  y.segment<3>(part.spin()) << 0.3, -0.2, 0.5;
  const VectorXd rate = VectorXd::Zero(y.size());
  ASSERT_GT(law.sample({0.0, y, rate}).normal_force, 1.0);
  constexpr double c = 10.0;
  const numerics::SparseMatrix& sparse = system.jacobian({0.0, y, rate}, c);
  const Eigen::Vector4d q = y.segment<4>(part.quaternion());
  VectorXd plus(y.size()), minus(y.size());
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    VectorXd direction = VectorXd::Unit(y.size(), k);
    // Along the sphere: the length of the quaternion has an equation of its own.
    if (k >= part.quaternion() && k < part.quaternion() + 4)
      direction.segment<4>(part.quaternion()) -= q[k - part.quaternion()] * q;
    constexpr double h = 1e-6;
    const VectorXd up = y + h * direction, down = y - h * direction;
    const VectorXd up_rate = rate + c * h * direction, down_rate = rate - c * h * direction;
    system.residual({0.0, up, up_rate}, plus);
    system.residual({0.0, down, down_rate}, minus);
    const VectorXd product = sparse * direction;
    // Central differences over 1e-6: 1e-7 of the largest entries, m c and k, some 3e3.
    EXPECT_LT(((plus - minus) / (2.0 * h) - product).lpNorm<Eigen::Infinity>(), 3e-4) << k;
  }
}

}  // namespace
}  // namespace snare::coupling
