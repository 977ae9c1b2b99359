#include "benchmarks/declared_push.hpp"

#include "base/units.hpp"
#include "coupling/statics/contact_switch.hpp"
#include "coupling/statics/push_setup.hpp"
#include "validation/declared_wire.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace snare::benchmarks {

namespace {

using base::mm;

/// A in x(L) = integral of cos(A sin(2 pi S/L)) dS = span, for which x(L)/L = J_0(A).
double shape_amplitude(double ratio) {
  double low = 0.0;
  double high = 2.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (std::cyl_bessel_j(0.0, middle) > ratio ? low : high) = middle;
  }
  return low;
}

}  // namespace

coupling::PushProblem declared_push() {
  coupling::PushProblem test = validation::declared_wire(87.5 * mm, 0.0);
  for (int i = 1; i <= 20; ++i) test.travel.push_back(1.5 * mm * i / 20);
  return test;
}

PressedWire pressed_wire(int elements, double travel) {
  coupling::PushSetup setup = coupling::prepare_push(declared_push(), elements, -1.0, 1);
  if (!setup.report.usable()) throw std::runtime_error(setup.report.message);
  PressedWire wire{std::move(setup.rod), std::move(setup.system), std::move(setup.start)};
  wire.system->sliding[0].status = coupling::ContactStatus::slip;
  numerics::PathWorkspace workspace;
  constexpr int steps = 10;
  for (int i = 1; i <= steps; ++i) {
    coupling::remember_contact(*wire.system, wire.point);
    const numerics::PathTangent t = numerics::tangent(*wire.system, wire.point, workspace, nullptr).value();
    const double factor = (travel * i / steps - wire.point.parameter) / t.parameter;
    wire.point.band += factor * t.band;
    wire.point.border += factor * t.border;
    wire.point.parameter = travel * i / steps;
    const numerics::SolveReport report = numerics::correct(*wire.system, wire.point, workspace, 20);
    if (!report.usable()) throw std::runtime_error(report.message);
  }
  coupling::remember_contact(*wire.system, wire.point);
  return wire;
}

PressedWire buckled_shape(int elements) {
  const coupling::PushProblem test = declared_push();
  const double length = test.wire.length;
  const wire::Controls controls{0.0, 0.5 * length, length};
  wire::PlanarRodProperties properties;
  properties.bending_stiffness = test.wire.bending_stiffness();
  properties.axial_stiffness = test.wire.axial_stiffness();
  properties.right.position = {test.mount.span, 0.0};
  PressedWire wire;
  wire.rod = std::make_unique<wire::PlanarRod>(wire::make_mesh(elements, 0.5, 0.0), properties);
  wire.system = std::make_unique<coupling::PushSystem>(*wire.rod, controls);

  const double amplitude = shape_amplitude(test.mount.span / length);
  const wire::MaterialMesh& mesh = wire.rod->mesh();
  wire.point.band.setZero(wire.rod->unknowns());
  for (int e = 0; e < mesh.edges(); ++e) {
    const double middle = 0.5 * (mesh.coordinate(e, controls) + mesh.coordinate(e + 1, controls));
    const double angle = amplitude * std::sin(2.0 * std::numbers::pi * middle / length);
    wire.point.band.segment<2>(2 * e + 2) =
        wire.point.band.segment<2>(2 * e) +
        mesh.rest_length(e, controls) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  coupling::SlidingContact pusher;
  pusher.node = mesh.contact_vertex();
  pusher.motion = Eigen::Vector2d::UnitY();
  pusher.centre = wire.point.band.segment<2>(2 * pusher.node);
  wire.system->sliding = {pusher};
  wire.point.border.setZero(wire.system->border_unknowns());
  wire.point.border[wire.system->pusher_rows().coordinate] = controls[1];
  coupling::remember_contact(*wire.system, wire.point);
  return wire;
}

void newton_iteration(coupling::PushSystem& system, const numerics::PathPoint& point,
                      numerics::PathWorkspace& workspace) {
  system.assemble(point, workspace.system, workspace.by_parameter);
  if (!std::isfinite(system.error(point, workspace.system)))
    throw std::runtime_error("a residual is not finite");
  if (!workspace.solver.factorize(workspace.system)) throw std::runtime_error("the matrix is singular");
  workspace.band_step = -workspace.system.band_residual;
  workspace.border_step = -workspace.system.border_residual;
  workspace.solver.solve(workspace.system, workspace.band_step, workspace.border_step);
}

std::vector<double> median_times(const std::vector<std::function<void()>>& works, int rounds, int repeats) {
  using Clock = std::chrono::steady_clock;
  std::vector<std::vector<double>> times(works.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < works.size(); ++k) {
      const Clock::time_point start = Clock::now();
      for (int i = 0; i < repeats; ++i) works[k]();
      times[k].push_back(std::chrono::duration<double>(Clock::now() - start).count() / repeats);
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& t : times) {
    const auto middle = t.begin() + static_cast<std::ptrdiff_t>(t.size() / 2);
    std::nth_element(t.begin(), middle, t.end());
    medians.push_back(*middle);
  }
  return medians;
}

}  // namespace snare::benchmarks
