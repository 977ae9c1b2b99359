// Stick and slip: derivatives, frames, energy, directions. Closed forms: validation/friction_checks.

#include "base/errors.hpp"
#include "coupling/dynamics/contact/contact_part.hpp"
#include "coupling/dynamics/joints/body_part.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/dae_jacobian.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/soft_wire.hpp"
#include "wire/motion/rod_in_motion.hpp"

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
        // Of order one: z in micrometres, w in units of its size, loads in units of 10 N, which they gain or
        // lose in 0.1 s or in 1 us.
        for (const double elastic_rate : {100.0, -1e7}) {
          const auto state = [&](const VectorXd& x) {
            return BristleState{1e-6 * x.segment<2>(0), speed * x.segment<2>(2), 10.0 * x[4], 10.0 * x[5]};
          };
          const auto flow = [&](const VectorXd& x) {
            return bristle_flow(friction, state(x), tangent_force(friction, state(x)), elastic_rate * x[6]);
          };
          const bool bristles = friction.has_bristle();
          const auto values = [&](const VectorXd& x) -> VectorXd {
            VectorXd v = VectorXd::Zero(4);
            v.head<2>() = tangent_force(friction, state(x)).force;
            if (bristles) v.tail<2>() = flow(x).flow / speed;
            return v;
          };
          VectorXd x(7);
          x << 0.6 * stretch, -0.8 * stretch, 0.8, -0.3, 1.1, 0.9, 1.0;
          const TangentForce t = tangent_force(friction, state(x));
          Eigen::MatrixXd analytic = Eigen::MatrixXd::Zero(4, 7);
          analytic.topRows<2>().leftCols<6>() << 1e-6 * t.by_bristle, speed * t.by_sliding,
              10.0 * t.by_normal, 10.0 * t.by_elastic;
          for (int k = 0; bristles && k < 7; ++k) {
            const VectorXd e = VectorXd::Unit(7, k);
            const BristleChange by{1e-6 * e.segment<2>(0), speed * e.segment<2>(2), 10.0 * e[4], 10.0 * e[5],
                                   elastic_rate * e[6]};
            analytic.col(k).tail<2>() = flow_change(friction, state(x), t, flow(x), by) / speed;
          }
          const test::DerivativeError error = test::compare_jacobian(values, x, analytic);
          EXPECT_LT(error.relative, 1e-8) << error.worst;
        }
      }
    }
  }
}

TEST(MotionFriction, CoefficientIsThatOfThePapers) {
  const MotionFriction f = papers_friction();  // Honda et al. 2014, Table 3
  EXPECT_DOUBLE_EQ(slip_coefficient(f, 0.0).value, 0.3);
  EXPECT_DOUBLE_EQ(slip_coefficient(f, 0.01).value, 0.3);
  EXPECT_DOUBLE_EQ(slip_coefficient(f, 0.505).value, 0.2);
  EXPECT_DOUBLE_EQ(slip_coefficient(f, 1.0).value, 0.1);
}

// The power of friction is that stored by the bristle, mu_s p_e z^2/(2 z_m), and heat, which is never
// negative: whatever the load does, whichever coefficient holds, and also where the bristle was stretched too
// far. Below its reach a bristle under a steady load does not creep.
TEST(MotionFriction, HeatIsNeverNegative) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const MotionFriction f = papers_friction();
  int slides = 0;
  for (int k = 0; k < 10000; ++k) {
    const double elastic = 5.0 * (1.0 + unit(random)),
                 normal = k % 3 == 0 ? elastic : 5.0 * (1.0 + unit(random));
    BristleState s{f.bristle_displacement * Vector2d(unit(random), unit(random)),
                   std::pow(10.0, 3.0 * unit(random) - 2.0) * Vector2d(unit(random), unit(random)), normal,
                   elastic};
    if (k % 4 == 0) s.bristle *= 2.0;
    const double elastic_rate = k % 5 == 0 ? 0.0 : unit(random) * std::pow(10.0, 4.0 + 3.0 * unit(random));
    const TangentForce t = tangent_force(f, s);
    const BristleFlow b = bristle_flow(f, s, t, elastic_rate);
    slides += t.slider_speed > 0.0 ? 1 : 0;
    if (t.slider_speed == 0.0 && elastic_rate == 0.0) {
      EXPECT_EQ(b.flow, s.elastic * s.sliding);
    }
    EXPECT_LE(t.force.norm(), f.static_coefficient * s.normal * (1.0 + 1e-12));
    // d/dt of the energy by its own definition, from p_e dz/dt and dp_e/dt.
    const double stored = f.static_coefficient / f.bristle_displacement *
                          (s.bristle.dot(b.flow) + 0.5 * elastic_rate * s.bristle.squaredNorm());
    const double taken = t.force.dot(s.sliding);
    const double round_off = 1e-12 * (std::abs(taken) + std::abs(stored));
    EXPECT_GE(taken - stored, -round_off);
    EXPECT_NEAR(b.heat, taken - stored, round_off);
  }
  EXPECT_GT(slides, 1000);
  EXPECT_LT(slides, 9000);
}

// A bristle that is loaded and unloaded while it sticks gives back what went in, and no more: with a spring
// that stiffened under its deflection each round would leave energy.
TEST(MotionFriction, AChangingLoadStoresNothing) {
  MotionFriction f = papers_friction();
  f.bristle_time = 1e-9;  // without a dashpot: forces to 1e-6
  double z = 0.0, taken = 0.0;
  const auto go = [&](double from, double to, double speed, double duration) {
    constexpr int steps = 20000;
    const double dt = duration / steps, load_rate = (to - from) / duration;
    for (int k = 0; k < steps; ++k) {
      const double load = from + (k + 0.5) * dt * load_rate;
      const BristleState s{{z, 0.0}, {speed, 0.0}, 1e3 * load, load};
      const TangentForce t = tangent_force(f, s);
      taken += dt * t.force.x() * speed;
      z += dt * bristle_flow(f, s, t, load_rate).flow.x() / load;
    }
  };
  for (int round = 0; round < 3; ++round) {
    go(1.0, 1.0, 4e-4, 1e-3);  // 0.4 um out under a light load
    go(1.0, 10.0, 0.0, 1e-3);  // the load grows
    go(10.0, 10.0, -z / 1e-3, 1e-3);
    go(10.0, 1.0, 0.0, 1e-3);
    EXPECT_LT(std::abs(z), 1e-10);
    // 20000 steps of first order: 1e-4 of the energy that is exchanged, 0.3 N/um (0.4 um)^2/2.
    EXPECT_GT(taken, -1e-3 * 2.4e-8);
  }
  EXPECT_NEAR(taken, 0.0, 1e-3 * 2.4e-8);
}

// At a constant coefficient more speed never takes force away, however far the bristle is stretched: the
// derivative by the sliding has no negative direction, and the force is Coulomb's at most.
TEST(MotionFriction, MoreSpeedNeverMeansLessForce) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  MotionFriction f = papers_friction();
  f.dynamic_coefficient = f.static_coefficient;
  for (int k = 0; k < 10000; ++k) {
    const BristleState s{2.0 * f.bristle_displacement * Vector2d(unit(random), unit(random)),
                         std::pow(10.0, 3.0 * unit(random) - 2.0) * Vector2d(unit(random), unit(random)),
                         10.0, 10.0};
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
  s.normal = s.elastic = 10.0;
  for (const Vector2d& w : {Vector2d(0.3, 0.0), Vector2d(-0.1, 0.2)}) {
    s.sliding = w;
    const double dt = 1e-4 * f.bristle_time;
    for (int k = 0; k < 400000; ++k)
      s.bristle += dt / s.elastic * bristle_flow(f, s, tangent_force(f, s), 0.0).flow;
    EXPECT_LT(
        (tangent_force(f, s).force - slip_coefficient(f, w.norm()).value * s.normal * w.normalized()).norm(),
        1e-6);
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
    contact.update_candidates(y);
  }
};

TEST(MotionFriction, JacobianMatchesDifferencesInStickAndSlip) {
  for (const double stretch :
       {0.3,
        // all that touches sticks, or slides: a derivative is not asked for where one becomes the other
        1.5}) {
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

/// A block of 1 kg that does not turn, with a flat underside, on the top of a thick arch of steel wire that
/// is bent by
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
  const auto place = [&](double a) -> Vector3d {
    return radius * Vector3d(std::sin(a), std::cos(a) - 1.0, 0.0);
  };
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

// Both directions of the tangent plane: a block that starts obliquely keeps its line and stops after v^2/(2
// mu g).
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
  EXPECT_THAT(message([](MotionFriction& f) { f.bristle_time = -1.0; }),
              HasSubstr("bristle_time = -1, must be > 0"));
  EXPECT_THAT(message([](MotionFriction& f) { f.dynamic_speed = 0.0; }),
              HasSubstr("and < dynamic_speed, or both 0"));
  EXPECT_THAT(message([](MotionFriction& f) {
                f.law = ContactFriction::smooth;
                f.static_speed = f.dynamic_speed = 0.0;
              }),
              HasSubstr("must be > 0 and < dynamic_speed"));
}

}  // namespace
}  // namespace snare::coupling
