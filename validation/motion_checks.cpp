#include "validation/motion_checks.hpp"

#include "base/units.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "coupling/statics/push_solver.hpp"
#include "numerics/dense_solvers.hpp"
#include "validation/declared_wire.hpp"
#include "wire/motion/rod_in_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace snare::validation {

namespace {

using coupling::Motion;
using coupling::MotionOptions;
using coupling::MotionResult;
using coupling::MotionSample;
using Eigen::Matrix3Xd;
using std::numbers::pi;

using base::mm;

/// A wire of another length than its specification's.
wire::RodInMotion rod_of(const wire::WireSpecification& w, double length, double span, int elements) {
  wire::RodInMotion rod = wire::rod_in_motion(w, span, elements);
  rod.length = length;
  return rod;
}

/// A straight wire between its mounts.
Motion straight(const wire::RodInMotion& rod) {
  Motion motion;
  motion.wires.push_back({"wire", rod, {}, {}});
  motion.wires[0].positions =
      coupling::straight_wire(rod, rod.properties.left.position, rod.properties.right.position);
  motion.wires[0].velocities = Matrix3Xd::Zero(3, rod.elements + 1);
  return motion;
}

/// The loose wire buckled to +y.
Motion buckled(const wire::RodInMotion& rod) {
  Motion motion = straight(rod);
  motion.wires[0].positions = coupling::resting_wire(rod);
  return motion;
}

/// Frequency [Hz] of the projection of the motion from its start on a shape of the vertices' displacements
/// (3, n), from rising zero crossings by linear interpolation. `expected` sets duration (eight periods) and
/// sampling.
double measured_frequency(Motion motion, const Matrix3Xd& shape, double expected, double speed,
                          int order = 5) {
  motion.wires[0].velocities = speed * shape;
  const Matrix3Xd rest = motion.wires[0].positions;
  MotionOptions options;
  options.duration = 8.2 / expected;
  options.output_interval = 1.0 / (400.0 * expected);
  options.relative_tolerance = 1e-9;  // of coordinates of 0.1 m: the vibration has down to 1e-7 m
  options.position_tolerance = 1e-10;
  options.velocity_tolerance = 1e-6;
  options.max_order = order;
  double last = 0.0;
  double last_time = 0.0;
  std::vector<double> crossings;
  const MotionResult result = coupling::simulate(motion, options, [&](const MotionSample& s) {
    const double u = (s.wires[0] - rest).cwiseProduct(shape).sum();
    if (last < 0.0 && u >= 0.0) crossings.push_back(last_time + (s.time - last_time) * (-last) / (u - last));
    last = u;
    last_time = s.time;
    return false;
  });
  if (!result.report.usable() || crossings.size() < 2) return not_computed;
  return static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
}

/// Material damping that quiets what the step does not resolve and moves a frequency f by (pi f tau)^2/2,
/// below 1e-6.
constexpr double faint = 1e-7;

Row frequency_row(const std::string& group, const std::string& name, const std::string& source, Kind kind,
                  double reference, double value) {
  return {group, name, "Hz", source, kind, reference, value, Limit::relative(1e-3)};
}

}  // namespace

std::vector<Row> clamped_frequency_rows() {
  constexpr std::array<double, 5> roots{4.730040744862704, 7.853204624095838, 10.995607838001671,
                                        14.137165491257464, 17.278759657399481};  // cos x cosh x = 1
  const wire::WireSpecification w = declared_specification();
  const double span = 175.0 * mm;
  wire::RodInMotion rod = rod_of(w, span, span, 200);
  rod.damping.bending_time = rod.damping.axial_time = faint;
  std::vector<Row> rows;
  for (std::size_t k = 0; k < roots.size(); ++k) {
    const double b = roots[k];
    const double ratio = (std::cosh(b) - std::cos(b)) / (std::sinh(b) - std::sin(b));
    Matrix3Xd shape = Matrix3Xd::Zero(3, rod.elements + 1);
    for (int i = 1; i < rod.elements; ++i) {
      const double x = b * i / rod.elements;
      shape(1, i) = std::cosh(x) - std::cos(x) - ratio * (std::sinh(x) - std::sin(x));
    }
    const double expected =
        b * b / (span * span) * std::sqrt(w.bending_stiffness() / w.mass_per_length()) / (2.0 * pi);
    rows.push_back(frequency_row("free vibration", fmt::format("clamped beam, mode {}", k + 1),
                                 "Euler-Bernoulli", Kind::closed_form, expected,
                                 measured_frequency(straight(rod), shape, expected, 0.01)));
  }
  return rows;
}

std::vector<Row> tensioned_frequency_rows() {
  const wire::WireSpecification w = declared_specification();
  const double span = 175.0 * mm;
  constexpr double tension = 50.0;
  const double stretch = 1.0 + tension / w.axial_stiffness();
  wire::RodInMotion rod = rod_of(w, span / stretch, span, 160);
  rod.properties.left.kind = rod.properties.right.kind = wire::SpatialEnd::Kind::pin;
  rod.damping.bending_time = rod.damping.axial_time = faint;
  std::vector<Row> rows;
  for (int k = 1; k <= 5; ++k) {
    Matrix3Xd shape = Matrix3Xd::Zero(3, rod.elements + 1);
    for (int i = 1; i < rod.elements; ++i) shape(1, i) = std::sin(pi * k * i / rod.elements);
    const double number = k * pi / span;
    const double mass = w.mass_per_length() / stretch;
    const double expected =
        number * std::sqrt((tension + w.bending_stiffness() * number * number) / mass) / (2.0 * pi);
    rows.push_back(frequency_row("free vibration", fmt::format("pinned beam under 50 N, mode {}", k),
                                 "Euler-Bernoulli with tension", Kind::closed_form, expected,
                                 measured_frequency(straight(rod), shape, expected, 0.01)));
  }
  return rows;
}

std::vector<Row> buckled_frequency_rows() {
  wire::RodInMotion rod = rod_of(declared_specification(), 180.0 * mm, 175.0 * mm, 60);
  const Motion motion = buckled(rod);
  // M x'' + K x = 0 in the plane with the statics' tangent, the angles of twist being at rest there.
  wire::SpatialRod statics(wire::MaterialMesh(30, 30, 0.0), rod.properties);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(statics.unknowns());
  for (int i = 0; i <= 60; ++i) q.segment<3>(4 * i) = motion.wires[0].positions.col(i);
  wire::RodAssembly tangent;
  statics.assemble(statics.make_state(q, {0.0, 0.5 * rod.length, rod.length}), {false, false, false},
                   tangent);
  constexpr int free = 2 * 59;
  Eigen::MatrixXd k(free, free);
  for (int a = 0; a < free; ++a) {
    for (int b = 0; b < free; ++b) {
      const int i = 4 * (a / 2 + 1) + a % 2;
      const int j = 4 * (b / 2 + 1) + b % 2;
      k(a, b) = std::abs(i - j) <= 10 ? tangent.hessian.lower(std::max(i, j), std::min(i, j)) : 0.0;
    }
  }
  k /= rod.mass_per_length * rod.length / rod.elements;
  const numerics::SymmetricEigen modes = numerics::symmetric_eigen(k);
  std::vector<Row> rows;
  for (int m = 0; m < 5; ++m) {
    Matrix3Xd shape = Matrix3Xd::Zero(3, 61);
    for (int a = 0; a < free; ++a) shape(a % 2, a / 2 + 1) = modes.vectors(a, m);
    shape /= shape.cwiseAbs().maxCoeff();
    const double expected = std::sqrt(modes.values[m]) / (2.0 * pi);
    Motion quiet = motion;
    quiet.wires[0].rod.damping.bending_time = quiet.wires[0].rod.damping.axial_time = faint;
    rows.push_back(frequency_row("free vibration", fmt::format("buckled wire, mode {} in its plane", m + 1),
                                 "eigenvalue of the static tangent", Kind::convergence, expected,
                                 measured_frequency(quiet, shape, expected, 0.001)));
  }
  return rows;
}

std::vector<Row> axial_wave_rows() {
  const wire::WireSpecification w = declared_specification();
  const double span = 175.0 * mm;
  wire::RodInMotion rod = rod_of(w, span, span, 100);
  Matrix3Xd shape = Matrix3Xd::Zero(3, rod.elements + 1);
  for (int i = 1; i < rod.elements; ++i) shape(0, i) = std::sin(pi * i / rod.elements);
  const double speed = std::sqrt(w.axial_stiffness() / w.mass_per_length());
  const double expected = speed / (2.0 * span);
  const double f = measured_frequency(straight(rod), shape, expected, 0.01);
  return {{"waves", "speed of axial waves", "m/s", "sqrt(EA/m)", Kind::closed_form, speed, 2.0 * span * f,
           Limit::relative(1e-3)}};
}

std::vector<Row> gravity_rows() {
  constexpr double g = 9.81;
  std::vector<Row> rows;
  // A hanging chain: J0(2 omega sqrt(L/g)) = 0 (D. Bernoulli 1732); bending a millionth of the weight's
  // stiffness.
  {
    wire::WireSpecification w = declared_specification();
    w.bending_stiffness_override = 1e-8;
    wire::RodInMotion rod = rod_of(w, 0.5, 0.5, 120);
    rod.properties.left.kind = wire::SpatialEnd::Kind::pin;
    rod.properties.right.kind = wire::SpatialEnd::Kind::free;
    rod.damping.axial_time = 1e-6;
    Motion motion = straight(rod);
    motion.gravity = {g, 0.0, 0.0};
    Matrix3Xd shape = Matrix3Xd::Zero(3, rod.elements + 1);
    constexpr std::array<double, 3> roots{2.404825557695773, 5.520078110286311, 8.653727912911013};
    for (std::size_t k = 0; k < roots.size(); ++k) {
      for (int i = 1; i <= rod.elements; ++i) {
        shape(1, i) =
            std::cyl_bessel_j(0.0, roots[k] * std::sqrt(1.0 - static_cast<double>(i) / rod.elements));
      }
      const double expected = 0.5 * roots[k] * std::sqrt(g / 0.5) / (2.0 * pi);
      rows.push_back(frequency_row("gravity", fmt::format("hanging chain, mode {}", k + 1),
                                   "Bernoulli: J0(2 w sqrt(L/g)) = 0", Kind::closed_form, expected,
                                   measured_frequency(motion, shape, expected, 1e-2, 2)));
    }
  }
  // A rod falls from the horizontal about a pin: a physical pendulum of the length 2L/3, a quarter of its
  // period T = 4 K(sin(pi/4)) sqrt(2L/3g).
  {
    wire::WireSpecification w = declared_specification();
    wire::RodInMotion rod = rod_of(w, 0.3, 0.3, 40);
    rod.properties.left.kind = wire::SpatialEnd::Kind::pin;
    rod.properties.right.kind = wire::SpatialEnd::Kind::free;
    rod.damping.bending_time = rod.damping.axial_time = 1e-4;
    Motion motion = straight(rod);
    motion.gravity = {0.0, -g, 0.0};
    const double quarter = std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt(2.0 * 0.3 / (3.0 * g));
    MotionOptions options;
    options.duration = 1.2 * quarter;
    options.output_interval = quarter / 500.0;
    options.relative_tolerance = 1e-7;
    options.position_tolerance = 1e-9;
    options.velocity_tolerance = 1e-6;
    double passed = not_computed;
    double last = 0.0;
    double last_time = 0.0;
    const MotionResult result = coupling::simulate(motion, options, [&](const MotionSample& s) {
      const double x = s.wires[0](0, rod.elements);
      if (last > 0.0 && x <= 0.0) passed = last_time + (s.time - last_time) * last / (last - x);
      last = x;
      last_time = s.time;
      return false;
    });
    if (!result.report.usable()) passed = not_computed;
    rows.push_back({"gravity", "falling rod, time from the horizontal to the vertical", "s",
                    "physical pendulum, elliptic integral", Kind::closed_form, quarter, passed,
                    Limit::relative(1e-3)});
  }
  return rows;
}

std::vector<Row> slow_push_rows() {
  // A ball moved at 5 mm/s pushes the buckled wire outward at its middle; the static force at the same travel
  // is that of a cylinder of the same radius on the same mesh.
  const wire::WireSpecification w = declared_specification();
  constexpr double radius = 6.0 * mm;
  coupling::PushProblem test;
  test.wire = w;
  test.mount.span = 175.0 * mm;
  test.contact_position = 87.5 * mm;
  test.pusher.radius = radius;
  test.travel = {1.0 * mm, 2.0 * mm};
  coupling::PushOptions push;
  push.elements = 200;
  push.grading = 0.0;
  const coupling::PushCurve curve = coupling::solve_push(test, push);

  wire::RodInMotion rod = rod_of(w, w.length, test.mount.span, 200);
  rod.damping.bending_time = rod.damping.axial_time = 1e-5;
  rod.damping.mass_rate = 200.0;
  Motion motion = buckled(rod);
  const double top = motion.wires[0].positions(1, 100);
  constexpr double speed = 5.0 * mm;
  const double clearance = 1e-6;
  coupling::MotionBody ball;
  ball.driven = true;
  ball.start.position = {87.5 * mm, top - radius - 0.5 * w.diameter - clearance, 0.0};
  ball.start.velocity = {0.0, speed, 0.0};
  motion.bodies.push_back(ball);
  coupling::MotionContact contact;
  contact.shape = std::make_shared<coupling::Ball>(radius);
  contact.wire_radius = 0.5 * w.diameter;
  motion.contacts.push_back(contact);
  MotionOptions options;
  options.duration = (2.0 * mm + clearance) / speed;
  options.output_interval = options.duration;
  double last = not_computed;
  const MotionResult result =
      coupling::simulate(motion, options, [&last](const coupling::MotionSample& sample) {
        last = sample.contacts[0].normal_force;
        return false;
      });
  if (!result.report.usable()) last = not_computed;
  std::vector<Row> rows;
  const double reference = curve.points.size() == 2 ? curve.points[1].force : not_computed;
  rows.push_back({"quasi-static limit", "ball at 5 mm/s, force at 2 mm", "N", "static curve of a cylinder",
                  Kind::convergence, reference, last, Limit::relative(1e-3)});
  return rows;
}

namespace {

/// A ball on a body of 8.9 kg at 0.1 m/s meets the buckled wire from inside the bulge.
struct Impact {
  MotionResult result;
  double velocity = 0.0;
  double spin = 0.0;
};

Impact impact(int elements, const MotionOptions& options, double damping) {
  const wire::WireSpecification w = declared_specification();
  wire::RodInMotion rod = rod_of(w, w.length, 175.0 * mm, elements);
  rod.damping.bending_time = rod.damping.axial_time = damping;
  Motion motion = buckled(rod);
  constexpr double radius = 6.0 * mm;
  const double top = motion.wires[0].positions(1, elements / 2);
  coupling::MotionBody body;
  body.properties.mass = 8.9;
  body.properties.inertia = 0.16 * Eigen::Matrix3d::Identity();
  body.start.position = {37.5 * mm, top - radius - 0.5 * w.diameter - 0.1 * mm - 100.0 * mm, 0.0};
  body.start.velocity = {0.0, 0.1, 0.0};
  motion.bodies.push_back(body);
  coupling::MotionContact contact;
  contact.shape = std::make_shared<coupling::Ball>(radius);
  contact.X_BS.p = {50.0 * mm, 100.0 * mm, 0.0};
  contact.wire_radius = 0.5 * w.diameter;
  motion.contacts.push_back(contact);
  Impact out;
  out.result = coupling::simulate(motion, options, [&](const MotionSample& s) {
    out.velocity = s.bodies[0].velocity.y();
    out.spin = s.bodies[0].spin.z();
    return false;
  });
  return out;
}

}  // namespace

std::vector<Row> impact_rows() {
  std::vector<Row> rows;
  MotionOptions options;
  options.duration = 0.04;
  const double energy = 0.5 * 8.9 * 0.01;
  const Impact usual = impact(60, options, 0.0);
  rows.push_back({"impact", "integrator's energy, default tolerances, over the impact energy", "",
                  "conservation", Kind::closed_form, 0.0, usual.result.energy.integrator / energy,
                  Limit::absolute(1e-3, "zero reference; the value is a share of the energy of the impact")});
  rows.push_back({"impact", "penetration", "m", "non-penetration", Kind::closed_form, 0.0,
                  usual.result.largest_penetration,
                  Limit::absolute(1e-6, "zero reference; the wire is 1.5 mm thick")});
  std::array<Impact, 3> meshes;
  constexpr std::array<int, 3> elements{50, 100, 200};
  for (std::size_t k = 0; k < 3; ++k) meshes[k] = impact(elements[k], options, 1e-6);
  for (std::size_t k = 0; k < 2; ++k) {
    rows.push_back({"impact", fmt::format("impulse with {} elements", elements[k]), "N s",
                    "with 200 elements", Kind::convergence, meshes[2].result.impulse[0].y(),
                    meshes[k].result.impulse[0].y(), Limit::relative(5e-3)});
    rows.push_back({"impact", fmt::format("rebound velocity with {} elements", elements[k]), "m/s",
                    "with 200 elements", Kind::convergence, meshes[2].velocity, meshes[k].velocity,
                    Limit::relative(5e-3)});
    rows.push_back({"impact", fmt::format("rebound spin with {} elements", elements[k]), "rad/s",
                    "with 200 elements", Kind::convergence, meshes[2].spin, meshes[k].spin,
                    Limit::relative(5e-3)});
  }
  return rows;
}

std::vector<Check> motion_checks() {
  return {{"clamped beam in motion", clamped_frequency_rows},
          {"tensioned beam in motion", tensioned_frequency_rows},
          {"buckled wire in motion", buckled_frequency_rows},
          {"axial waves", axial_wave_rows},
          {"chain and pendulum", gravity_rows},
          {"slow push", slow_push_rows},
          {"impact", impact_rows}};
}

}  // namespace snare::validation
