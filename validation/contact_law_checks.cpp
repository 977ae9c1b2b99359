#include "validation/contact_law_checks.hpp"

#include "coupling/dynamics/run/simulate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace snare::validation {

namespace {

using coupling::MotionResult;
using std::numbers::pi;

constexpr double ball_mass = 2.0;  // [kg]

/// A body that strikes the plane y = 0 of a law.
struct Strike {
  double speed_after = not_computed;
  double duration = not_computed;
  double peak = not_computed;
};

Strike strike(const coupling::ContactLaw& law, double speed, double expected_duration) {
  coupling::Motion motion;
  coupling::MotionBody body;
  body.properties.mass = ball_mass;
  body.start.position = {0.0, -0.05 * speed * expected_duration, 0.0};
  body.start.velocity = {0.0, speed, 0.0};
  motion.bodies.push_back(body);
  coupling::PointContactLaw spring;
  spring.law = law;
  motion.point_contacts.push_back(spring);
  coupling::MotionOptions options;
  options.duration = 3.0 * expected_duration;
  options.max_step = expected_duration / 500.0;  // a peak between two steps is (pi/500)^2/8 higher
  options.relative_tolerance = 1e-9;
  options.position_tolerance = 1e-11;
  options.velocity_tolerance = 1e-9;
  options.max_order = 5;
  Strike s;
  const MotionResult r = coupling::simulate(motion, options, [&](const coupling::MotionSample& sample) {
    s.speed_after = -sample.bodies[0].velocity.y();
    return false;
  });
  if (!r.report.usable() || r.events.size() != 2) return {};
  s.duration = r.events[1].time - r.events[0].time;
  s.peak = r.peak_force[0];
  return s;
}

}  // namespace

// m v dv/dd = -k d^p (1 + a v), a = c/k: the depth goes out between approach v and rebound u,
//   a v - ln(1 + a v) = -a u - ln(1 - a u),  whatever m, k, p (Hunt, Crossley 1975; Marhefka, Orin 1999).
std::vector<Row> hunt_crossley_rows() {
  std::vector<Row> rows;
  constexpr double speed = 0.2;
  for (const double p : {1.0, 1.5, 2.5}) {
    for (const double av : {0.05, 0.5, 3.0}) {
      const double k = 3e4 * std::pow(1e-3, 1.0 - p);  // some 30 N at 1 mm
      const double left = av - std::log1p(av);
      double low = 0.0;
      double high = 1.0;
      for (int i = 0; i < 200; ++i) {
        const double u = 0.5 * (low + high);
        (-u - std::log1p(-u) < left ? low : high) = u;
      }
      const double expected = low / av;  // a u over a v
      const double duration = pi * std::sqrt(ball_mass / 3e4);
      const Strike s = strike(coupling::power_law(k, p, av / speed * k, 1.0), speed, duration);
      rows.push_back({"contact laws",
                      fmt::format("Hunt-Crossley, p = {:g}, c v/k = {:g}, restitution", p, av), "",
                      "a v - ln(1 + a v) = -a u - ln(1 - a u)", Kind::closed_form, expected,
                      s.speed_after / speed, Limit::relative(1e-4)});
    }
  }
  return rows;
}

// k d + c d' that does not pull: e = exp(-b t), t the time until the force is zero (Schwager, Poeschel 2007),
// b = c/2m.
std::vector<Row> dashpot_rows() {
  std::vector<Row> rows;
  constexpr double k = 3e4;
  constexpr double speed = 0.2;
  const double w0 = std::sqrt(k / ball_mass);
  for (const double ratio : {0.02, 0.2, 0.6, 0.9}) {
    const double b = ratio * w0;
    const double w = std::sqrt(w0 * w0 - b * b);
    const double angle = std::atan2(2.0 * b * w, w * w - b * b);  // in (0, pi) for every ratio below 1
    const double expected = std::exp(-b / w * (pi - angle));
    const Strike s = strike(coupling::spring_dashpot(k, 2.0 * b * ball_mass), speed, pi / w0);
    rows.push_back({"contact laws", fmt::format("spring and dashpot, {:g} of critical, restitution", ratio),
                    "", "Schwager, Poeschel 2007", Kind::closed_form, expected, s.speed_after / speed,
                    Limit::relative(1e-4)});
  }
  return rows;
}

// F = K d^(3/2): d_max = (5 m v^2/(4 K))^(2/5), the contact lasts 2 d_max/v int_0^1 dx/sqrt(1 - x^(5/2)) =
// 2.9432 d_max/v.
std::vector<Row> hertz_rows() {
  constexpr double k = 1e9;
  constexpr double speed = 0.5;
  const double depth = std::pow(1.25 * ball_mass * speed * speed / k, 0.4);
  // 4/5 sqrt(pi) Gamma(2/5)/Gamma(9/10)
  const double factor = 0.8 * std::sqrt(pi) * std::tgamma(0.4) / std::tgamma(0.9);
  const Strike s = strike(coupling::power_law(k, 1.5, 0.0, 1.0), speed, factor * depth / speed);
  return {{"contact laws", "Hertz, duration of the contact", "s", "2.9432 d_max/v", Kind::closed_form,
           factor * depth / speed, s.duration, Limit::relative(1e-4)},
          {"contact laws", "Hertz, peak force", "N", "K d_max^(3/2)", Kind::closed_form,
           k * std::pow(depth, 1.5), s.peak, Limit::relative(1e-4)},
          {"contact laws", "Hertz, restitution", "", "elastic", Kind::closed_form, 1.0, s.speed_after / speed,
           Limit::relative(1e-5)}};
}

std::vector<Check> contact_law_checks() {
  return {{"restitution of Hunt-Crossley", hunt_crossley_rows},
          {"restitution of spring and dashpot", dashpot_rows},
          {"Hertz's impact", hertz_rows}};
}

}  // namespace snare::validation
