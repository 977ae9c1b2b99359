#include "validation/elastica_push.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "validation/elastica_flow.hpp"
#include "validation/elastica_shooting.hpp"

namespace snare::validation {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using numerics::SolveReport;
using numerics::Termination;
using shooting::Control;
using shooting::Demand;
using shooting::Shooting;

[[nodiscard]] std::string out_of_range(const char* name, double value, const char* requirement) {
  return std::string("elastica: ") + name + " = " + std::to_string(value) + ", must be " + requirement;
}

void require(bool holds, const char* name, double value, const char* requirement) {
  if (!holds) throw std::invalid_argument(out_of_range(name, value, requirement));
}

void check(const ElasticaPush& p) {
  require(p.wire.length > 0.0 && std::isfinite(p.wire.length), "length", p.wire.length, "finite and > 0");
  require(p.wire.bending_stiffness > 0.0 && std::isfinite(p.wire.bending_stiffness), "bending_stiffness",
          p.wire.bending_stiffness, "finite and > 0");
  require(p.wire.axial_stiffness > 0.0, "axial_stiffness", p.wire.axial_stiffness, "> 0");
  require(std::isfinite(p.wire.natural_curvature), "natural_curvature", p.wire.natural_curvature, "finite");
  const bool taut = p.span >= p.wire.length;
  require(p.span > 0.0 && std::isfinite(p.span), "span", p.span, "finite and > 0");
  require(!taut || std::isfinite(p.wire.axial_stiffness), "span", p.span, "< length of an inextensible wire");
  if (p.contact == ElasticaContact::material_point) {
    require(p.material_coordinate > 0.0 && p.material_coordinate < p.wire.length, "material_coordinate",
            p.material_coordinate, "in (0, length)");
  } else {
    require(p.position > 0.0 && p.position < p.span, "position", p.position, "in (0, span)");
  }
  require(p.radius >= 0.0 && std::isfinite(p.radius), "radius", p.radius, "finite and >= 0");
  require(p.contact == ElasticaContact::sliding || p.radius == 0.0, "radius", p.radius,
          "0 unless the contact slides");
  require(std::isfinite(p.friction_slope), "friction_slope", p.friction_slope, "finite");
  require(p.pieces_per_side >= 2, "pieces_per_side", p.pieces_per_side, ">= 2");
}

// A point on the path, with what a predictor needs.
struct Place {
  VectorXd z;
  bool wrapped = false;
};

class Path {
 public:
  explicit Path(const ElasticaPush& problem) : problem_(problem), shooting_((check(problem), problem)) {
    report_ = shooting_.start(here_.z);
    if (report_.usable()) touch_ = here_.z[shooting_.height(false)];
  }

  [[nodiscard]] ElasticaState to(double travel);
  [[nodiscard]] std::vector<ElasticaState> through_folds(double step, int count);

 private:
  [[nodiscard]] SolveReport settle(Place& place, double height) const;
  [[nodiscard]] ElasticaState describe() const;

  ElasticaPush problem_;
  Shooting shooting_;
  Place here_;
  double touch_ = 0.0;
  double step_ = 0.005;  // of the pusher's height, over L
  SolveReport report_;
};

// Solves at a given height in the kind of contact that is admissible there.
SolveReport Path::settle(Place& place, double height) const {
  const Demand demand{Control::height, height, {}, {}, 0.0};
  const Index m = 8 * shooting_.pieces();
  SolveReport report;
  for (int change = 0; change < 4; ++change) {
    report = shooting_.solve(place.z, place.wrapped, demand);
    if (!report.usable()) return report;
    if (!place.wrapped && shooting_.relative_curvature(place.z) > 1.0 + 1e-12) {
      VectorXd z(m + 7);
      z.head(m + 5) = place.z.head(m + 5);
      z[m + 5] = z[m + 4];
      z[m + 6] = place.z[m + 5];
      place = {z, true};
    } else if (place.wrapped && place.z[m + 5] < place.z[m + 4]) {
      VectorXd z(m + 6);
      z.head(m + 5) = place.z.head(m + 5);
      z[m + 4] = 0.5 * (place.z[m + 4] + place.z[m + 5]);
      z[m + 5] = place.z[m + 6];
      place = {z, false};
    } else {
      return report;
    }
  }
  report.termination = Termination::step_too_small;
  report.message = "neither the point contact nor the wrapped one is admissible";
  return report;
}

constexpr double kLargestStep = 0.01;
constexpr double kSmallestStep = 1e-7;

ElasticaState Path::to(double travel) {
  const double target = touch_ + shooting_.sigma() * travel / problem_.wire.length;
  std::optional<Place> before;
  while (report_.usable()) {
    const double height = here_.z[shooting_.height(here_.wrapped)];
    const double remaining = target - height;
    if (remaining == 0.0) break;
    const double part = std::min(1.0, step_ / std::abs(remaining));
    const double next = part == 1.0 ? target : height + part * remaining;
    Place trial = here_;
    if (before && before->wrapped == here_.wrapped) {
      const Index at = shooting_.height(here_.wrapped);
      trial.z += (next - height) / (height - before->z[at]) * (here_.z - before->z);
    }
    const SolveReport report = settle(trial, next);
    if (report.usable()) {
      // The equation of the height is linear: it holds to rounding; make it hold exactly.
      trial.z[shooting_.height(trial.wrapped)] = next;
      before = here_;
      here_ = trial;
      report_ = report;
      if (report.iterations <= 6) step_ = std::min(kLargestStep, 1.5 * step_);
    } else {
      before.reset();
      step_ *= 0.5;
      if (step_ < kSmallestStep) {
        report_ = report;
        report_.termination = Termination::step_too_small;
      }
    }
  }
  return describe();
}

std::vector<ElasticaState> Path::through_folds(double step, int count) {
  std::vector<ElasticaState> states;
  if (!report_.usable()) return {describe()};
  const Index n = shooting_.size(false);
  // Length along the path: pusher's height, and mean square of the sections' y and angle.
  VectorXd weight = VectorXd::Zero(n);
  for (Index i = 0; i < 2 * shooting_.pieces(); ++i)
    weight[4 * i + 1] = weight[4 * i + 2] = 0.5 / shooting_.pieces();
  const Index at = shooting_.height(false);
  weight[at] = 1.0;
  VectorXd direction = VectorXd::Zero(n);
  direction[at] = shooting_.sigma();
  states.push_back(describe());
  while (static_cast<int>(states.size()) < count) {
    Demand demand{Control::arc_length, 0.0, direction, here_.z, 0.0};
    VectorXd right = VectorXd::Zero(n);
    right[n - 1] = 1.0;
    VectorXd tangent = shooting_.assemble(here_.z, false, demand).jacobian.partialPivLu().solve(right);
    tangent /= std::sqrt(tangent.dot(weight.cwiseProduct(tangent)));
    direction = weight.cwiseProduct(tangent);
    demand.direction = direction;
    double length = step;
    Place trial;
    do {
      demand.step = length;
      trial = {here_.z + length * tangent, false};
      report_ = shooting_.solve(trial.z, false, demand);
      length *= 0.5;
    } while (!report_.usable() && length > 1e-6 * step);
    if (report_.usable()) {
      here_ = trial;
      if (problem_.radius > 0.0 && shooting_.relative_curvature(here_.z) > 1.0) {
        report_.termination = Termination::step_too_small;
        report_.message = "the wire begins to wrap the cylinder";
      }
    }
    states.push_back(describe());
    if (!report_.usable()) break;
  }
  return states;
}

ElasticaState Path::describe() const {
  ElasticaState state;
  state.report = report_;
  const bool wrapped = here_.wrapped;
  const VectorXd& z = here_.z;
  const double length = problem_.wire.length;
  const double unit_moment = problem_.wire.bending_stiffness / length;
  const double unit_force = unit_moment / length;
  const ElasticaForce left = Shooting::force(z, shooting_.left_force());
  const ElasticaForce right = Shooting::force(z, shooting_.right_force());
  const int m = shooting_.pieces();
  state.wrapped = wrapped;
  state.pusher_height = z[shooting_.height(wrapped)] * length;
  state.travel = shooting_.sigma() * (z[shooting_.height(wrapped)] - touch_) * length;
  state.force = shooting_.sigma() * (left.y - right.y) * unit_force;
  state.force_along_chord = (left.x - right.x) * unit_force;
  state.reaction_left_y = -left.y * unit_force;
  state.reaction_right_y = right.y * unit_force;
  state.contact_begin = z[shooting_.begin()] * length;
  state.contact_end = z[shooting_.end(wrapped)] * length;
  state.determinant_positive = shooting_.determinant_positive(z, wrapped, z[shooting_.height(wrapped)]);

  const auto add = [&](double arc, const ElasticaSection& p, ElasticaForce n) {
    state.shape.push_back({arc * length, p.x * length, p.y * length, p.angle, p.moment * unit_moment,
                           section_forces(n, p.angle).tension * unit_force});
  };
  const double left_piece = z[shooting_.begin()] / m;
  const double right_begin = z[shooting_.end(wrapped)];
  const double right_piece = (1.0 - right_begin) / m;
  for (Index i = 0; i < m; ++i) add(static_cast<double>(i) * left_piece, Shooting::section(z, i), left);
  add(z[shooting_.begin()], elastica_flow(shooting_.law(), Shooting::section(z, m - 1), left, left_piece).end,
      left);
  state.contact_x = state.shape.back().x;
  state.contact_y = state.shape.back().y;
  for (Index i = 0; i < m; ++i) {
    add(right_begin + static_cast<double>(i) * right_piece, Shooting::section(z, m + i), right);
  }
  add(1.0, elastica_flow(shooting_.law(), Shooting::section(z, 2 * m - 1), right, right_piece).end, right);
  state.tension_left = state.shape.front().tension;
  state.tension_right = state.shape.back().tension;
  return state;
}

}  // namespace

ElasticaState push(const ElasticaPush& problem, double travel) {
  return Path(problem).to(travel);
}

std::vector<ElasticaState> push_path(const ElasticaPush& problem, const std::vector<double>& travels) {
  std::vector<ElasticaState> states;
  Path path(problem);
  for (const double travel : travels) {
    states.push_back(path.to(travel));
    if (!states.back().report.usable()) break;
  }
  return states;
}

std::vector<ElasticaState> push_through_folds(const ElasticaPush& problem, double step, int count) {
  return Path(problem).through_folds(step, count);
}

}  // namespace snare::validation
