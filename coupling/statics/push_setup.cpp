#include "coupling/statics/push_setup.hpp"

#include "wire/statics/loose_wire.hpp"
#include "wire/statics/planar_properties.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;

double effective_radius(double radius, double diameter) {
  return radius > 0.0 ? radius + 0.5 * diameter : 0.0;  // a knife edge meets the centreline
}

SlidingContact make_pusher(const PushProblem& test, int node) {
  const double towards = test.pusher.direction == PushDirection::outward ? 1.0 : -1.0;
  SlidingContact pusher;
  pusher.node = node;
  pusher.control = 1;
  pusher.side = towards;
  pusher.radius = effective_radius(test.pusher.radius, test.wire.diameter);
  pusher.friction = test.pusher.friction;
  pusher.motion = towards * Vector2d(std::sin(test.pusher.misalignment), std::cos(test.pusher.misalignment));
  pusher.centre = {test.contact_position, 0.0};
  return pusher;
}

// Wire resting on two supports, the pusher touching it from the other side; straight, without force or
// weight.
void rest_on_supports(PushSetup& setup, const wire::Controls& controls) {
  PushSystem& system = *setup.system;
  const wire::MaterialMesh& mesh = setup.rod->mesh();
  setup.start.band.resize(setup.rod->unknowns());
  for (int i = 0; i <= mesh.edges(); ++i) {
    setup.start.band.segment<2>(2 * i) = Vector2d(mesh.coordinate(i, controls) - controls[0], 0.0);
  }
  setup.start.border.setZero(system.border_unknowns());
  for (std::size_t k = 0; k < system.sliding.size(); ++k) {
    const auto control = static_cast<std::size_t>(system.sliding[k].control);
    setup.start.border[system.sliding_rows(k).coordinate] = controls[control];
  }
}

}  // namespace

wire::PlanarRodProperties rod_properties(const PushProblem& test) {
  return wire::planar_rod_properties(test.wire, test.mount, {test.gravity[0], test.gravity[1]});
}

wire::Controls initial_controls(const PushProblem& test) {
  const double length = test.wire.length;
  if (test.mount.kind == wire::MountKind::supports) {
    const double overhang = 0.5 * (length - test.mount.span);
    return {overhang, overhang + test.contact_position, overhang + test.mount.span};
  }
  return {0.0, test.contact_position / test.mount.span * length, length};
}

std::vector<SlidingContact> make_contacts(const PushProblem& test, const wire::MaterialMesh& mesh,
                                          const wire::Controls& controls) {
  SlidingContact pusher = make_pusher(test, mesh.contact_vertex());
  if (test.mount.kind != wire::MountKind::supports) return {pusher};
  pusher.centre -= pusher.side * pusher.radius * Vector2d::UnitY();
  pusher.holds_material = true;
  pusher.last_coordinate = controls[1];
  std::vector<SlidingContact> contacts{pusher};
  for (const int end : {0, 2}) {
    SlidingContact support;
    support.node = end == 0 ? 0 : mesh.edges();
    support.control = end;
    support.side = -pusher.side;
    support.friction = test.pusher.friction;
    support.status = support.friction > 0.0 ? ContactStatus::stick : ContactStatus::slip;
    support.radius =
        test.mount.support_radius > 0.0 ? test.mount.support_radius + 0.5 * test.wire.diameter : 0.0;
    support.centre = {end == 0 ? 0.0 : test.mount.span, -support.side * support.radius};
    support.last_coordinate = controls[static_cast<std::size_t>(end)];
    contacts.push_back(support);
  }
  return contacts;
}

namespace {

/// The mesh of a push; grading < 0: as boundary layers at the highest tension of interest ask for.
wire::MaterialMesh push_mesh(const PushProblem& test, int edges, double grading, int coarsening) {
  const double length = test.wire.length;
  const double fraction = test.contact_position / test.mount.span;
  if (grading < 0.0) {
    const int contact = wire::make_mesh(edges, fraction, 0.0).contact_vertex();
    constexpr double strain = 5e-3;  // about where steel wire yields: the highest tension of interest
    const double layer = std::sqrt(test.wire.bending_stiffness() / (strain * test.wire.axial_stiffness()));
    const double left = wire::grading_for_layer(layer, fraction * length, contact);
    const double right = wire::grading_for_layer(layer, (1.0 - fraction) * length, edges - contact);
    grading = std::max(left, right);
  }
  const wire::MaterialMesh mesh = wire::make_mesh(edges, fraction, grading);
  return coarsening > 1 ? mesh.coarsened(coarsening) : mesh;
}

/// The loose wire between mounts that hold. In an unstable shape the contact vertex is moved to where the
/// pusher comes, so that Newton's method does not wander off to another shape: `controls` say where it is.
wire::LooseWire loose_wire(const PushProblem& test, const wire::MaterialMesh& mesh, wire::Controls& controls,
                           int& iterations) {
  PushProblem holding = test;
  holding.mount.slip_tension.reset();
  const wire::PlanarRod held(mesh, rod_properties(holding));
  wire::LooseWire loose = wire::find_loose_wire(held, controls, test.bulge.mode);
  iterations = loose.report.iterations;
  if (test.bulge.mode <= 1 || !loose.report.usable()) return loose;
  for (int i = 0; i < mesh.edges(); ++i) {
    const double x0 = wire::vertex(loose.state, i).x();
    const double x1 = wire::vertex(loose.state, i + 1).x();
    if (x0 > test.contact_position || x1 < test.contact_position) continue;
    const double part = (test.contact_position - x0) / (x1 - x0);
    controls[1] = (1.0 - part) * mesh.coordinate(i, loose.state.controls) +
                  part * mesh.coordinate(i + 1, loose.state.controls);
  }
  loose = wire::find_loose_wire(held, controls, test.bulge.mode);
  iterations += loose.report.iterations;
  return loose;
}

/// Solves with the pusher at the wire and no force between them, and puts it where it touches.
void find_touch(PushSystem& system, const wire::MaterialMesh& mesh, PushSetup& setup) {
  SlidingContact& pusher = system.sliding.front();
  pusher.status = ContactStatus::touching;
  numerics::PathWorkspace workspace;
  const numerics::SolveReport touched = numerics::correct(system, setup.start, workspace, 50);
  setup.iterations += touched.iterations;
  setup.report = touched;
  if (!touched.usable()) {
    setup.report.message = "the pusher does not touch the wire in its initial shape";
    return;
  }
  double& gap = setup.start.border[system.pusher_rows().gap];
  pusher.centre += gap * pusher.approach();
  gap = 0.0;
  setup.natural_height = wire::vertex(system.state(setup.start), mesh.contact_vertex()).y();
}

void prepare_on_supports(const PushProblem& test, const wire::MaterialMesh& mesh, PushSetup& setup) {
  if (test.wire.natural_curvature != 0.0) {
    // It would touch the supports in a shape and a roll of its own.
    setup.report.end(numerics::Termination::step_too_small,
                     "a naturally curved wire on supports is not computed");
    return;
  }
  const wire::Controls controls = initial_controls(test);
  setup.system = std::make_unique<PushSystem>(*setup.rod, controls);
  setup.system->sliding = make_contacts(test, mesh, controls);
  setup.system->compliance = test.pusher.compliance;
  rest_on_supports(setup, controls);
  // From the straight wire to the one that sags under its weight.
  if (setup.rod->properties().weight != Vector2d::Zero()) find_touch(*setup.system, mesh, setup);
}

/// Brings the pusher to the loose wire without a force.
void touch(const PushProblem& test, const wire::LooseWire& loose, const wire::Controls& controls,
           const wire::MaterialMesh& mesh, PushSetup& setup) {
  setup.system = std::make_unique<PushSystem>(*setup.rod, controls);
  PushSystem& system = *setup.system;
  system.sliding = make_contacts(test, mesh, controls);
  SlidingContact& pusher = system.sliding.front();
  pusher.centre.y() = wire::vertex(loose.state, mesh.contact_vertex()).y() - pusher.side * pusher.radius;
  system.compliance = test.pusher.compliance;
  system.mounts = slipping_mounts(test.mount, test.pusher.friction, controls);

  setup.start.band = loose.state.q;
  setup.start.border.setZero(system.border_unknowns());
  setup.start.border[system.pusher_rows().coordinate] = controls[1];
  for (std::size_t k = 0; k < system.mounts.size(); ++k) {
    if (system.mounts[k].feeds()) setup.start.border[system.mount_row(k)] = system.mounts[k].last;
  }
  find_touch(system, mesh, setup);
}

}  // namespace

PushSetup prepare_push(const PushProblem& test, int edges, double grading, int coarsening) {
  const wire::MaterialMesh mesh = push_mesh(test, edges, grading, coarsening);
  PushSetup setup;
  setup.rod = std::make_unique<wire::PlanarRod>(mesh, rod_properties(test));
  if (test.mount.kind == wire::MountKind::supports) {
    prepare_on_supports(test, mesh, setup);
    return setup;
  }
  wire::Controls controls = initial_controls(test);
  const wire::LooseWire loose = loose_wire(test, mesh, controls, setup.iterations);
  setup.report = static_cast<const numerics::SolveReport&>(loose.report);
  if (loose.report.usable()) touch(test, loose, controls, mesh, setup);
  return setup;
}

}  // namespace snare::coupling
