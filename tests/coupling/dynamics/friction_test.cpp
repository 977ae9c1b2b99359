// Stick and slip: derivatives, frames, energy, directions. Closed forms: validation/friction_checks.

#include "base/errors.hpp"
#include "coupling/dynamics/body_part.hpp"
#include "coupling/dynamics/contact_part.hpp"
#include "coupling/dynamics/simulate.hpp"
#include "coupling/dynamics/start.hpp"
#include "tests/support/dae_jacobian.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/soft_wire.hpp"
#include "wire/rod_constants.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace snare::coupling {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

MotionFriction papers_friction() {
  return {0.3, 0.1, 0.01, 1.0};
}

// Bristles that stick, slide, and have been stretched too far.
TEST(MotionFriction, ForceAndRateHaveExactDerivatives) {
  MotionFriction smooth = papers_friction();
  smooth.law = ContactFriction::smooth;
  for (const MotionFriction& friction : {papers_friction(), smooth}) {
    for (const double speed : {0.004, 0.3, 2.0}) {
      for (const double stretch : {0.5, 0.9995, 1.2}) {
        // Of order one: z in micrometres, w in units of its size.
        const auto state = [&](const VectorXd& x) {
          return BristleState{1e-6 * x.segment<2>(0), speed * x.segment<2>(2), 10.0 * x[4]};
        };
        const auto values = [&](const VectorXd& x) -> VectorXd {
          VectorXd v(4);
          v << tangent_force(friction, state(x)).force, bristle_rate(friction, state(x)).rate / speed;
          return v;
        };
        VectorXd x(5);
        x << 0.6 * stretch, -0.8 * stretch, 0.8, -0.3, 1.1;
        const TangentForce t = tangent_force(friction, state(x));
        const BristleRate r = bristle_rate(friction, state(x));
        Eigen::MatrixXd analytic = Eigen::MatrixXd::Zero(4, 5);
        analytic.topRows<2>() << 1e-6 * t.by_bristle, speed * t.by_sliding, 10.0 * t.by_normal;
        analytic.bottomLeftCorner<2, 4>() << 1e-6 * r.by_bristle / speed, r.by_sliding;
        const test::DerivativeError error = test::compare_jacobian(values, x, analytic);
        EXPECT_LT(error.relative, 1e-8) << error.worst;
      }
    }
  }
}

TEST(MotionFriction, CoefficientIsThatOfThePapers) {
  const MotionFriction f = papers_friction();  // Honda et al. 2014, Table 3
  EXPECT_DOUBLE_EQ(slip_coefficient(f, 0.0), 0.3);
  EXPECT_DOUBLE_EQ(slip_coefficient(f, 0.01), 0.3);
  EXPECT_DOUBLE_EQ(slip_coefficient(f, 0.505), 0.2);
  EXPECT_DOUBLE_EQ(slip_coefficient(f, 1.0), 0.1);
}

// Under a constant load and coefficient what goes in is what the bristle stores and what becomes heat, never negative; below
// its reach it does not creep. What was stretched too far is no exception.
TEST(MotionFriction, HeatIsNeverNegative) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  MotionFriction f = papers_friction();
  f.dynamic_coefficient = f.static_coefficient;
  int slides = 0;
  for (int k = 0; k < 10000; ++k) {
    BristleState s{f.bristle_displacement * Vector2d(unit(random), unit(random)),
                   std::pow(10.0, 3.0 * unit(random) - 2.0) * Vector2d(unit(random), unit(random)), 10.0};
    if (k % 4 == 0) s.bristle *= 2.0;
    const Vector2d rate = bristle_rate(f, s).rate;
    if ((s.bristle + f.bristle_time * s.sliding).norm() < f.bristle_displacement) {
      EXPECT_EQ(rate, s.sliding);
    } else {
      ++slides;
    }
    const double stored = f.static_coefficient * s.normal / f.bristle_displacement * s.bristle.dot(rate);
    EXPECT_GE(tangent_force(f, s).force.dot(s.sliding) - stored, -1e-12);
  }
  EXPECT_GT(slides, 1000);
  EXPECT_LT(slides, 9000);
}

// At a constant coefficient more speed never takes force away, however far the bristle is stretched: the derivative by the
// sliding has no negative direction, and the force is Coulomb's at most.
TEST(MotionFriction, MoreSpeedNeverMeansLessForce) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  MotionFriction f = papers_friction();
  f.dynamic_coefficient = f.static_coefficient;
  for (int k = 0; k < 10000; ++k) {
    const BristleState s{2.0 * f.bristle_displacement * Vector2d(unit(random), unit(random)),
                         std::pow(10.0, 3.0 * unit(random) - 2.0) * Vector2d(unit(random), unit(random)), 10.0};
    const TangentForce t = tangent_force(f, s);
    const Vector2d direction(unit(random), unit(random));
    EXPECT_GE(direction.dot(t.by_sliding * direction), -1e-12 * t.by_sliding.norm());
    EXPECT_LE(t.force.norm(), f.static_coefficient * s.normal * (1.0 + 1e-12));
  }
}

// Steady sliding: Coulomb's force along the velocity, also after it has turned.
TEST(MotionFriction, SlidesAlongItsVelocity) {
  const MotionFriction f = papers_friction();
  BristleState s;
  s.normal = 10.0;
  for (const Vector2d& w : {Vector2d(0.3, 0.0), Vector2d(-0.1, 0.2)}) {
    s.sliding = w;
    const double dt = 1e-4 * f.bristle_time;
    for (int k = 0; k < 400000; ++k) s.bristle += dt * bristle_rate(f, s).rate;
    EXPECT_LT((tangent_force(f, s).force - slip_coefficient(f, w.norm()) * s.normal * w.normalized()).norm(), 1e-6);
  }
}

/// A soft wire of 0.2 m between clamps, bent at random, and a ball of a spinning body in contact with it.
struct Touching {
  wire::RodPart rod;
  BodyPart body;
  ContactPart contact;
  numerics::DaeSystem system;
  VectorXd y;

  static wire::RodInMotion soft_rod() {
    wire::RodInMotion r = test::soft_wire(8);
    r.damping = {};
    return r;
  }
  static MotionBody ball() {
    MotionBody b;
    b.properties.mass = 0.05;
    b.properties.inertia = Vector3d(2e-5, 3e-5, 4e-5).asDiagonal();
    b.start.position = {0.08, -0.0125, 0.004};
    b.start.velocity = {0.0, 0.1, 0.0};
    return b;
  }
  static MotionContact touch(const MotionFriction& friction) {
    MotionContact c;
    c.shape = std::make_shared<Ball>(0.01);
    c.X_BS.p = {0.015, 0.0, -0.004};
    c.wire_radius = 0.001;
    c.friction = friction;
    c.foundation = {3e8, 1.0};
    return c;
  }

  explicit Touching(const MotionFriction& friction)
      : rod("wire", soft_rod(), {}),
        body(ball(), Vector3d::Zero(), {}),
        contact(touch(friction), touch(friction).shape, rod, body),
        system({&rod, &body, &contact}),
        y(VectorXd::Zero(system.size())) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Matrix3Xd positions = straight_wire(soft_rod(), Vector3d::Zero(), {0.2, 0.0, 0.0});
    Matrix3Xd velocities = Matrix3Xd::Zero(3, 9);
    for (int i = 1; i < 8; ++i) {
      positions.col(i) += 1e-3 * Vector3d(unit(random), unit(random), 0.0);
      velocities.col(i) = 0.1 * Vector3d(unit(random), unit(random), 0.0);
    }
    rod.place(positions, velocities, y);
    body.place(y);
    y.segment<4>(body.quaternion()) = Eigen::Vector4d(0.98, 0.1, -0.12, 0.11).normalized();
    y.segment<3>(body.spin()) << 0.3, -0.2, 0.5;
    // 2 um deep: a fifth of a newton.
    y[body.position() + 1] += contact.search().nearest(y).gap + 2e-6;
    contact.look_around(y);
  }
};

TEST(MotionFriction, JacobianMatchesDifferencesInStickAndSlip) {
  for (const double stretch :
       {0.3, 1.5}) {  // all that touches sticks, or slides: a derivative is not asked for where one becomes the other
    SCOPED_TRACE(stretch);
    MotionFriction soft = papers_friction();
    // A bristle as soft as the wire's axial stiffness of 1e3/0.025, so that no row drowns the others.
    soft.bristle_displacement = 1e-4;
    soft.bristle_time = 1e-4;
    Touching t(soft);
    for (int i = 0; i < t.rod.vertices(); ++i)
      t.y.segment<2>(t.contact.bristle_of(i)) = stretch * soft.bristle_displacement * Vector2d(0.6, -0.8);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    VectorXd rate(t.y.size());
    for (double& r : rate) r = 0.1 * unit(random);
    const Eigen::MatrixXd directions = test::along_unit_quaternions(t.y, {t.body.quaternion()});
    const test::DerivativeError error = test::compare_dae_jacobian(t.system, t.y, rate, directions, 1e-4);
    // The derivative's integral by Gauss's rule, not that of the rule, beside differences of the force.
    EXPECT_LT(error.relative, 1e-4) << error.worst;
  }
}

// A superposed rigid rotation, with its velocities, turns the force and leaves the bristle's rate alone.
TEST(MotionFriction, BristleIsObjective) {
  for (const double stretch : {0.3, 0.9995}) {
    Touching t(papers_friction());
    for (int i = 0; i < t.rod.vertices(); ++i)
      t.y.segment<2>(t.contact.bristle_of(i)) = stretch * 1e-6 * Vector2d(0.6, -0.8);
    const Eigen::AngleAxisd turn(0.7, Vector3d(1.0, -2.0, 0.5).normalized());
    const Vector3d spin(20.0, -30.0, 10.0);
    const Eigen::Matrix3d r = turn.toRotationMatrix();
    VectorXd z = t.y;
    const auto move = [&](int position, int velocity) {
      z.segment<3>(position) = r * t.y.segment<3>(position);
      z.segment<3>(velocity) = r * t.y.segment<3>(velocity) + spin.cross(z.segment<3>(position));
    };
    for (int i = 0; i < t.rod.vertices(); ++i) move(t.rod.position_of(i), t.rod.velocity_of(i));
    move(t.body.position(), t.body.velocity());
    const Eigen::Vector4d q = t.y.segment<4>(t.body.quaternion());
    const Eigen::Quaterniond body = Eigen::Quaterniond(turn) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    z.segment<4>(t.body.quaternion()) << body.w(), body.x(), body.y(), body.z();
    z.segment<3>(t.body.spin()) += body.conjugate() * spin;
    const VectorXd rate = VectorXd::Zero(t.y.size());
    const Vector3d before = t.contact.sums(t.y).force, after = t.contact.sums(z).force;
    EXPECT_GT(before.norm(), 0.05);
    EXPECT_LT((after - r * before).norm(), 1e-7 * before.norm());
    VectorXd rate_before = rate;
    VectorXd rate_after = rate;
    t.contact.set_bristle_rates(t.y, rate_before);
    t.contact.set_bristle_rates(z, rate_after);
    EXPECT_GT(rate_before.norm(), 1e-3);
    EXPECT_LT((rate_after - rate_before).norm(), 1e-7 * rate_before.norm());
  }
}

/// The flat underside y = 0 of a block above.
class Underside final : public ContactShape {
 public:
  [[nodiscard]] DistanceField at(const Vector3d& p) const override {
    return {-p.y(), -Vector3d::UnitY(), Eigen::Matrix3d::Zero()};
  }
  [[nodiscard]] std::vector<Eigen::Matrix3Xd> drawing() const override { return {}; }
};

/// A block of 1 kg that does not turn, with a flat underside, on the top of a thick arch of steel wire that is bent by
/// nature: 20 mm in radius, 6 mm thick.
Motion block_on_arch() {
  constexpr double radius = 0.02;
  constexpr double half = 0.5;
  constexpr int elements = 12;
  constexpr double thickness = 6e-3;
  wire::WireSpecification w;
  w.diameter = thickness;
  w.youngs_modulus = 193e9;
  w.poisson_ratio = 0.29;
  w.density = 7930.0;
  w.length = elements * 2.0 * radius * std::sin(half / elements);
  wire::RodInMotion rod = wire::rod_in_motion(w, 0.0, elements);
  rod.damping.bending_time = rod.damping.axial_time = 1e-4;
  const auto place = [&](double a) -> Vector3d { return radius * Vector3d(std::sin(a), std::cos(a) - 1.0, 0.0); };
  const auto along = [](double a) { return Vector3d(std::cos(a), -std::sin(a), 0.0); };
  rod.properties.natural_curvature = {-1.0 / radius, 0.0};
  for (const double side : {-1.0, 1.0}) {
    wire::SpatialEnd& end = side < 0.0 ? rod.properties.left : rod.properties.right;
    end.position = place(side * half);
    end.direction = along(side * half);
    end.director = {std::sin(side * half), std::cos(side * half), 0.0};
  }
  Motion motion;
  Matrix3Xd positions(3, elements + 1);
  for (int i = 0; i <= elements; ++i) positions.col(i) = place(half * (2.0 * i / elements - 1.0));
  motion.wires.push_back({"wire", rod, positions, {}});
  MotionBody body;
  body.properties.mass = 1.0;
  body.properties.inertia = 1e9 * Eigen::Matrix3d::Identity();
  body.start.position = {0.0, 0.5 * thickness, 0.0};
  motion.bodies.push_back(body);
  MotionContact contact;
  contact.shape = std::make_shared<Underside>();
  contact.wire_radius = 0.5 * thickness;
  motion.contacts.push_back(contact);
  motion.gravity = {0.0, -9.81, 0.0};
  return motion;
}

// Both directions of the tangent plane: a block that starts obliquely keeps its line and stops after v^2/(2 mu g).
TEST(MotionFriction, ObliqueBlockStopsOnItsLine) {
  Motion motion = block_on_arch();
  MotionFriction& f = motion.contacts[0].friction;
  f.static_coefficient = f.dynamic_coefficient = 0.2;
  f.static_speed = f.dynamic_speed = 0.0;
  const Vector3d direction(0.6, 0.0, 0.8);
  constexpr double speed = 0.15;
  motion.bodies[0].start.velocity = speed * direction;
  MotionOptions options;
  options.duration = 0.3;
  options.relative_tolerance = 1e-6;
  options.position_tolerance = 1e-9;
  options.velocity_tolerance = 1e-6;
  Vector3d end;
  bool sticks = false;
  const MotionResult r = simulate(motion, options, [&](const MotionSample& s) {
    end = s.bodies[0].position;
    sticks = s.contacts[0].sticking;
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_TRUE(sticks);
  const double path = speed * speed / (2.0 * 0.2 * 9.81);
  // The arch gives by some micrometres, and so does the bristle.
  EXPECT_NEAR(end.x(), 0.6 * path, 1e-3 * path);
  EXPECT_NEAR(end.z(), 0.8 * path, 1e-3 * path);
  EXPECT_NEAR(r.energy.dissipated, 0.5 * speed * speed, 2e-3 * 0.5 * speed * speed);
  ASSERT_FALSE(r.events.empty());
  EXPECT_EQ(r.events[0].kind, MotionEvent::Kind::touch);
}

TEST(MotionFriction, WrongNumbersAreNamed) {
  const auto message = [](const std::function<void(MotionFriction&)>& spoil) -> std::string {
    Motion motion = block_on_arch();
    motion.contacts[0].friction = papers_friction();
    spoil(motion.contacts[0].friction);
    return test::refusal([&] { return simulate(motion, {}); });
  };
  using testing::HasSubstr;
  EXPECT_THAT(message([](MotionFriction& f) { f.static_coefficient = 0.05; }),
              HasSubstr("at least the dynamic coefficient"));
  EXPECT_THAT(message([](MotionFriction& f) { f.dynamic_coefficient = -0.1; }),
              HasSubstr("contact.friction.dynamic_coefficient = -0.1, must be >= 0"));
  EXPECT_THAT(message([](MotionFriction& f) { f.bristle_displacement = 0.0; }),
              HasSubstr("contact.friction.bristle_displacement = 0, must be > 0"));
  EXPECT_THAT(message([](MotionFriction& f) { f.bristle_time = -1.0; }), HasSubstr("bristle_time = -1, must be > 0"));
  EXPECT_THAT(message([](MotionFriction& f) { f.dynamic_speed = 0.0; }), HasSubstr("and < dynamic_speed, or both 0"));
  EXPECT_THAT(message([](MotionFriction& f) {
                f.law = ContactFriction::smooth;
                f.static_speed = f.dynamic_speed = 0.0;
              }),
              HasSubstr("must be > 0 and < dynamic_speed"));
}

}  // namespace
}  // namespace snare::coupling
