#include "coupling/statics/push_sensitivity.hpp"

#include "coupling/statics/push_setup.hpp"

#include <Eigen/Geometry>

#include <cassert>
#include <cmath>
#include <utility>

namespace snare::coupling {

namespace {

using Eigen::Vector2d;

Vector2d turned(const Vector2d& v, double angle) {
  return Eigen::Rotation2Dd(angle) * v;
}

/// The point moved by a multiple of a change.
numerics::PathPoint moved(const numerics::PathPoint& at, const numerics::PathPoint& change, double amount) {
  return {at.band + amount * change.band, at.border + amount * change.border,
          at.parameter + amount * change.parameter};
}

/// Positions that the mounts of this rod hold, in the order of the band unknowns; zero elsewhere.
Eigen::VectorXd held_positions(const wire::PlanarRod& rod) {
  Eigen::VectorXd held = Eigen::VectorXd::Zero(rod.unknowns());
  const auto put = [&held](const wire::PlanarEnd& end, int row) {
    if (end.kind == wire::PlanarEnd::Kind::free) return;
    held.segment<2>(row) = end.position;
  };
  put(rod.properties().left, 0);
  put(rod.properties().right, rod.unknowns() - 2);
  return held;
}

}  // namespace

PushSensitivity::PushSensitivity(const PushProblem& test, const wire::MaterialMesh& mesh,
                                 const std::vector<PushVariation>& variations) {
  for (const PushVariation& variation : variations) {
    assert(variation.step > 0.0);
    Varied varied;
    varied.step = variation.step;
    varied.travel = variation.travel;
    varied.mount_compliance = variation.mount_compliance;
    for (const int k : {0, 1}) {
      Side& side = varied.sides[static_cast<std::size_t>(k)];
      side.amount = k == 0 ? -variation.step : variation.step;
      PushProblem changed = test;
      if (variation.apply) variation.apply(changed, side.amount);
      side.rod = std::make_unique<wire::PlanarRod>(mesh, rod_properties(changed));
      const wire::Controls controls = initial_controls(changed);
      side.system = std::make_unique<PushSystem>(*side.rod, controls);
      side.contacts = make_contacts(changed, mesh, controls);
      side.controls = controls;
      side.system->compliance = changed.pusher.compliance;
      side.mounts = slipping_mounts(changed.mount, test.pusher.friction, controls);
    }
    const auto& [minus, plus] = varied.sides;
    const double twice = 2.0 * variation.step;
    varied.held = (held_positions(*plus.rod) - held_positions(*minus.rod)) / twice;
    for (std::size_t k = 0; k < plus.contacts.size(); ++k) {
      varied.centre.emplace_back((plus.contacts[k].centre - minus.contacts[k].centre) / twice);
      varied.memory.coordinate.push_back(
          (plus.contacts[k].last_coordinate - minus.contacts[k].last_coordinate) / twice);
    }
    varied.memory.angle.assign(plus.contacts.size(), 0.0);
    for (std::size_t k = 0; k < plus.mounts.size(); ++k) {
      varied.memory.mounts.push_back((plus.mounts[k].last - minus.mounts[k].last) / twice);
    }
    varied_.push_back(std::move(varied));
  }
  force_by_.assign(varied_.size(), 0.0);
}

PushSensitivity::Memories PushSensitivity::memories() const {
  Memories result;
  result.of_variations.reserve(varied_.size());
  for (const Varied& varied : varied_) result.of_variations.push_back(varied.memory);
  result.force_by = force_by_;
  return result;
}

void PushSensitivity::restore(const Memories& memories) {
  for (std::size_t k = 0; k < varied_.size(); ++k) varied_[k].memory = memories.of_variations[k];
  force_by_ = memories.force_by;
}

// Derivatives of the controls at the last accepted point.
wire::Controls PushSensitivity::controls_by(const PushSystem& system, const Varied& varied) {
  const Memory& memory = varied.memory;
  wire::Controls by{};
  by[2] = (varied.sides[1].controls[2] - varied.sides[0].controls[2]) / (2.0 * varied.step);
  if (system.sliding.size() > 1) by[2] = 0.0;  // supports: a contact's coordinate, below
  for (std::size_t k = 0; k < system.sliding.size(); ++k) {
    by[static_cast<std::size_t>(system.sliding[k].control)] += memory.coordinate[k];
  }
  for (std::size_t k = 0; k < system.mounts.size(); ++k) {
    if (system.mounts[k].feeds()) by[static_cast<std::size_t>(system.mounts[k].control())] = memory.mounts[k];
  }
  return by;
}

// Slips of the system's sections, and the material that they belong to, with the constants of the changed
// test.
void PushSensitivity::put_sections(const wire::SectionMemory& sections, const PushSystem& system,
                                   const Varied& varied, Side& side) const {
  const Memory& memory = varied.memory;
  wire::SectionMemory& changed = side.system->sections;
  changed = sections;
  const auto shift = [&side](std::vector<double>& values, const std::vector<double>& rates) {
    for (std::size_t i = 0; i < rates.size() && i < values.size(); ++i) values[i] += side.amount * rates[i];
  };
  shift(changed.bending, memory.bending);
  shift(changed.axial, memory.axial);
  const wire::Controls by = controls_by(system, varied);
  for (std::size_t k = 0; k < 3; ++k) changed.controls[k] += side.amount * (by[k] + memory.moved[k]);
}

void PushSensitivity::carry_sections(const wire::SectionMemory& before, const PushSystem& system,
                                     double travel) {
  if (!system.rod().has_memory()) return;
  const double step = travel - system.drift.travel;
  for (Varied& varied : varied_) {
    Memory& memory = varied.memory;
    wire::Controls moved{};
    for (std::size_t k = 0; k < 3; ++k) {
      moved[k] = step * memory.rate[k] + (varied.travel - memory.change.parameter) * system.drift.rate[k];
    }
    std::array<wire::SectionMemory, 2> carried;
    for (std::size_t k = 0; k < 2; ++k) {
      Side& side = varied.sides[k];
      put_sections(before, system, varied, side);
      wire::Controls to = side.system->sections.controls;
      for (std::size_t c = 0; c < 3; ++c) {
        to[c] += system.sections.controls[c] - before.controls[c] + side.amount * moved[c];
      }
      side.system->carry_sections(to);
      carried[k] = side.system->sections;
    }
    const auto rates = [&varied](const std::vector<double>& from, const std::vector<double>& to,
                                 std::vector<double>& rate) {
      for (std::size_t i = 0; i < rate.size() && i < to.size(); ++i)
        rate[i] = (to[i] - from[i]) / (2.0 * varied.step);
    };
    rates(carried[0].bending, carried[1].bending, memory.bending);
    rates(carried[0].axial, carried[1].axial, memory.axial);
    memory.moved = moved;
  }
}

// The states of the system's contacts with the constants of the changed test.
void PushSensitivity::put_states(const PushSystem& system, Varied& varied, Side& side) const {
  side.system->restore(system.contact_states());
  ContactStates& states = *side.system;
  const Memory& memory = varied.memory;
  for (std::size_t k = 0; k < states.sliding.size(); ++k) {
    SlidingContact& contact = states.sliding[k];
    const SlidingContact& constants = side.contacts[k];
    contact.radius = constants.radius;
    contact.friction = constants.friction;
    contact.motion = constants.motion;
    contact.centre += side.amount * varied.centre[k];
    contact.last_coordinate += side.amount * memory.coordinate[k];
    contact.last_tangent = turned(contact.last_tangent, side.amount * memory.angle[k]);
  }
  for (WrappedContact& contact : states.wrapped) {
    contact.friction = side.contacts.front().friction;
    const auto known = memory.radial.find(contact.node);
    if (known != memory.radial.end())
      contact.last_radial = turned(contact.last_radial, side.amount * known->second);
  }
  put_sections(system.sections, system, varied, side);
  for (std::size_t k = 0; k < states.mounts.size(); ++k) {
    SlippingMount& mount = states.mounts[k];
    mount.limit = side.mounts[k].limit;
    mount.compliance = side.mounts[k].compliance + side.amount * varied.mount_compliance[mount.right ? 1 : 0];
    mount.last += side.amount * memory.mounts[k];
  }
}

numerics::PathPoint PushSensitivity::solve(const PushSystem& system, const numerics::PathPoint& at,
                                           numerics::PathWorkspace& workspace, Varied& varied) {
  numerics::PathPoint change{varied.held, Eigen::VectorXd::Zero(at.border.size()), varied.travel};
  if (varied.mount_compliance != std::array<double, 2>{}) {
    // A spring of stiffness 1/c under the gradient g of the wire's energy: q = x - c g.
    // Of a mount that slides that spring is part of its equation.
    const auto& reactions = system.mount_reactions();
    std::array<bool, 2> held{true, true};
    for (const SlippingMount& mount : system.mounts) held[mount.right ? 1 : 0] = mount.feeds();
    if (held[0]) change.band[0] -= varied.mount_compliance[0] * reactions[0].x();
    if (held[1]) change.band[at.band.size() - 2] -= varied.mount_compliance[1] * reactions[1].x();
  }
  // The differences begin with the change at the point before. A slider that has slipped by less than its
  // memory differs would turn back on one side if the unknowns did not go along.
  const numerics::PathPoint& last = varied.memory.change;
  if (system.rod().has_memory() && last.band.size() == at.band.size() &&
      last.border.size() == at.border.size()) {
    const Eigen::Index inner = at.band.size() - 4;
    change.band.segment(2, inner) = last.band.segment(2, inner);
    change.border = last.border;
  }
  Eigen::VectorXd band = Eigen::VectorXd::Zero(at.band.size());
  Eigen::VectorXd border = Eigen::VectorXd::Zero(at.border.size());
  for (Side& side : varied.sides) {
    put_states(system, varied, side);
    side.system->assemble_residual(moved(at, change, side.amount), scratch_, by_parameter_);
    band -= scratch_.band_residual / (2.0 * side.amount);
    border -= scratch_.border_residual / (2.0 * side.amount);
  }
  workspace.solver.solve(workspace.system, band, border);
  change.band += band;
  change.border += border;
  return change;
}

void PushSensitivity::begin(PushSystem& system, const numerics::PathPoint& at,
                            numerics::PathWorkspace& workspace) {
  if (system.sliding.front().status != ContactStatus::touching) {
    force_by_.assign(varied_.size(), 0.0);  // on supports the wire is straight and the centres known
    return;
  }
  system.assemble(at, workspace.system, workspace.by_parameter);
  workspace.factored = workspace.solver.factorize(workspace.system);
  if (!workspace.factored) return;
  for (Varied& varied : varied_) {
    // The travel counts from here: it does not change, where the pusher touches does.
    const double travel = std::exchange(varied.travel, 0.0);
    const numerics::PathPoint change = solve(system, at, workspace, varied);
    varied.travel = travel;
    varied.centre.front() += change.border[system.pusher_rows().gap] * system.sliding.front().approach();
    remember(system, at, change, varied);
  }
}

void PushSensitivity::advance(PushSystem& system, const numerics::PathPoint& at,
                              numerics::PathWorkspace& workspace) {
  force_by_.assign(varied_.size(), 0.0);
  if (system.sliding.front().status == ContactStatus::open) return;
  system.assemble(at, workspace.system, workspace.by_parameter);
  workspace.factored = workspace.solver.factorize(workspace.system);
  if (!workspace.factored) return;
  const Vector2d force = system.pusher_force(at);
  for (std::size_t k = 0; k < varied_.size(); ++k) {
    Varied& varied = varied_[k];
    const numerics::PathPoint change = solve(system, at, workspace, varied);
    const Vector2d by_motion =
        (varied.sides[1].contacts.front().motion - varied.sides[0].contacts.front().motion) /
        (2.0 * varied.step);
    force_by_[k] = system.pusher_force(change).dot(system.sliding.front().motion) + force.dot(by_motion);
    remember(system, at, change, varied);
  }
}

void PushSensitivity::advance_at_touch(PushSystem& system, const numerics::PathPoint& at,
                                       numerics::PathWorkspace& workspace) {
  std::vector<double> travels;
  for (Varied& varied : varied_) travels.push_back(std::exchange(varied.travel, 0.0));
  advance(system, at, workspace);
  for (std::size_t k = 0; k < varied_.size(); ++k) varied_[k].travel = travels[k];
}

void PushSensitivity::remember(const PushSystem& system, const numerics::PathPoint& at,
                               const numerics::PathPoint& change, Varied& varied) const {
  // Directions by central differences over the change of the whole state.
  const PushSystem& minus = *varied.sides[0].system;
  const PushSystem& plus = *varied.sides[1].system;
  const numerics::PathPoint low = moved(at, change, -varied.step);
  const numerics::PathPoint high = moved(at, change, varied.step);
  const wire::PlanarState low_state = minus.state(low);
  const wire::PlanarState high_state = plus.state(high);
  const wire::Controls controls_before = controls_by(system, varied);
  for (std::size_t k = 0; k < system.sliding.size(); ++k) {
    varied.memory.coordinate[k] = change.border[system.sliding_rows(k).coordinate];
    varied.memory.angle[k] = angle_between(minus.tangent_at(minus.sliding[k], low_state).t,
                                           plus.tangent_at(plus.sliding[k], high_state).t) /
                             (2.0 * varied.step);
  }
  varied.memory.radial.clear();
  for (const WrappedContact& contact : system.wrapped) {
    const Vector2d from = wire::vertex(low_state, contact.node) - minus.pusher_centre(low);
    const Vector2d to = wire::vertex(high_state, contact.node) - plus.pusher_centre(high);
    varied.memory.radial[contact.node] = angle_between(from, to) / (2.0 * varied.step);
  }
  for (std::size_t k = 0; k < system.mounts.size(); ++k) {
    varied.memory.mounts[k] = (plus.mount_place(k, high) - minus.mount_place(k, low)) / (2.0 * varied.step);
  }
  if (!system.rod().has_memory()) return;
  // The sliders follow the moved states; a kink between the two is as rare as a reading that falls on it.
  const wire::SectionMemory before = minus.rod().remembered(low_state);
  const wire::SectionMemory after = plus.rod().remembered(high_state);
  const auto rates = [&varied](const std::vector<double>& from, const std::vector<double>& to) {
    std::vector<double> result(to.size());
    for (std::size_t i = 0; i < to.size(); ++i) result[i] = (to[i] - from[i]) / (2.0 * varied.step);
    return result;
  };
  varied.memory.bending = rates(before.bending, after.bending);
  varied.memory.axial = rates(before.axial, after.axial);
  // (S - S_0) / (d - d_0)
  const double step = at.parameter - system.drift.travel;
  if (system.has_rate(step)) {
    const wire::Controls now = system.state(at).controls;
    const wire::Controls by = controls_by(system, varied);
    for (std::size_t k = 0; k < 3; ++k) {
      const double rate = (now[k] - system.drift.controls[k]) / step;
      varied.memory.rate[k] =
          (by[k] - controls_before[k] - rate * (change.parameter - varied.memory.change.parameter)) / step;
    }
  }
  varied.memory.change = change;
  varied.memory.moved = {};
}

}  // namespace snare::coupling
