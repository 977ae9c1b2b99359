#include "wire/motion/rod_part.hpp"

#include "wire/motion/bending_cell.hpp"
#include "wire/motion/curved_rod.hpp"
#include "wire/motion/rod_damping.hpp"
#include "wire/motion/strand_friction.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace snare::wire {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using numerics::DaePoint;

RodPart::RodPart(std::string name, const RodInMotion& rod, const RodTolerances& tolerances)
    : name_(std::move(name)), tolerances_(tolerances), model_(rod), forces_(model_), stiffness_(model_) {
  band_.resize(model_.bands());
}

void RodPart::declare(numerics::DaeLayout& layout) {
  model_.declare(layout, name_, tolerances_);
}

void RodPart::attach_pattern(const numerics::SparseMatrix& pattern) {
  slots_.attach(model_, pattern);
  stiffness_.attach(model_, slots_);
}

void RodPart::rates(std::vector<std::pair<int, int>>& pairs) const {
  for (int i = 0; i < vertices(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (!is_held(i, k)) pairs.emplace_back(position_of(i) + k, velocity_of(i) + k);
    }
  }
}

void RodPart::place(const Matrix3Xd& positions, const Matrix3Xd& velocities, Eigen::VectorXd& y) {
  const int n = vertices();
  assert(positions.cols() == n);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model_.bands());
  for (int i = 0; i < n; ++i) {
    q.segment<3>(RodModel::block * i) = positions.col(i);
    y.segment<3>(position_of(i)) = positions.col(i);
    y[angle_of(i)] = 0.0;
    y.segment<3>(velocity_of(i)).setZero();
    if (velocities.cols() == n) y.segment<3>(velocity_of(i)) = velocities.col(i);
  }
  accepted_.state = rod().make_state(q, model_.controls());
  accepted_.take_edges();
  begin_from_accepted();
  if (model_.is_curved()) {
    y.segment(model_.curvature_of(0), 2 * n) =
        balanced_curvatures(model_, accepted_, {0.0, y, Eigen::VectorXd::Zero(y.size())}).reshaped();
  }
}

namespace {

constexpr double round_off = 1e-12;  // of directions [-], and of places [m]

/// Whether a mount is its own mirror image in the plane across an axis at a place on it; one that gives does
/// so along x.
bool is_mirrored(const SpatialEnd& end, int normal, double offset) {
  if (end.kind == SpatialEnd::Kind::free) return true;
  if (std::abs(end.position[normal] - offset) > round_off || (end.gives() && normal == 0)) return false;
  return !end.orients() || (std::abs(end.direction[normal]) <= round_off && end.twist_angle == 0.0);
}

}  // namespace

std::optional<RodPlane> RodPart::plane_across(int normal) const {
  const SpatialRodProperties& p = model_.properties();
  const SpatialState& state = accepted_.state;
  const double offset = vertex(state, 0)[normal];
  for (const End end : ends) {
    if (is_carried(end) || !is_mirrored(p.end(end), normal, offset)) return std::nullopt;
  }
  for (int i = 0; i < vertices(); ++i) {
    if (std::abs(vertex(state, i)[normal] - offset) > round_off) return std::nullopt;
  }
  std::vector<Frame> frames = state.frames;
  for (const std::optional<Frame>& mount : {state.left_mount, state.right_mount}) {
    if (mount) frames.push_back(*mount);
  }
  // Of director m1 across the plane kappa_2 = -m1.kb is in it, of m1 in it kappa_1 = m2.kb (W.24).
  const Frame& first = frames.front();
  const bool stands_across = std::abs(first.director[normal]) > 0.5;
  const double size = stands_across ? 1.0 : 0.0;
  for (const Frame& f : frames) {
    if (std::abs(std::abs(f.director[normal]) - size) > round_off) return std::nullopt;
  }
  for (const double m : state.reference_twist) {
    if (std::abs(m) > round_off) return std::nullopt;
  }
  RodPlane plane{normal, {(normal + 1) % 3, (normal + 2) % 3}, stands_across ? 1 : 0, 1.0};
  const double across = stands_across ? -first.director[normal] : first.tangent.cross(first.director)[normal];
  plane.sign = across > 0.0 ? 1.0 : -1.0;
  if (p.weight[normal] != 0.0 || p.natural_curvature[plane.odd()] != 0.0 || p.natural_twist != 0.0)
    return std::nullopt;
  return plane;
}

void RodPart::work_in(const std::optional<RodPlane>& plane) {
  forces_.restrict_to_plane(plane);
  stiffness_.restrict_to_plane(plane);
  if (slots_.is_attached()) stiffness_.attach(model_, slots_);
  y_.resize(0);
}

// The angles theta are odd, and of curvatures and strands those towards the director that stands across the
// plane.
std::vector<int> RodPart::restrict_to_plane(const RodPlane& plane) {
  work_in(plane);
  std::vector<int> unknowns;
  for (int i = 0; i < vertices(); ++i) {
    unknowns.insert(unknowns.end(),
                    {position_of(i) + plane.normal, velocity_of(i) + plane.normal, angle_of(i)});
    if (model_.is_curved()) unknowns.push_back(model_.curvature_of(i) + plane.odd());
    if (model_.strands().act()) unknowns.push_back(strand_of(i) + plane.odd());
  }
  return unknowns;
}

void RodPart::leave_plane() {
  work_in(std::nullopt);
}

void RodPart::take_unknowns(const numerics::VectorView& y) {
  for (int i = 0; i < vertices(); ++i) {
    band_.segment<3>(RodModel::block * i) = y.segment<3>(position_of(i));
    band_[RodModel::block * i + RodModel::angle] = y[angle_of(i)];
  }
}

void RodPart::carry(End end, std::function<MountMotion(const numerics::VectorView& y)> motion) {
  assert(model_.properties().end(end).kind != SpatialEnd::Kind::free &&
         !model_.properties().end(end).gives());
  carried_[index_of(end)] = std::move(motion);
  model_.release(end);
}

void RodPart::set_mounts(const numerics::VectorView& y, RodInstant& instant) const {
  for (const End end : ends) {
    if (!is_carried(end)) continue;
    const MountMotion motion = carried_[index_of(end)](y);
    std::optional<Frame>& frame = end == End::left ? instant.state.left_mount : instant.state.right_mount;
    if (frame) frame = motion.frame;
    instant.spin[index_of(end)] = motion.angular;
  }
}

bool RodPart::is_evaluated(const DaePoint& at) const {
  return y_.size() == at.y.size() && y_ == at.y && rate_ == at.rate;
}

// Residual and Jacobian, and what is asked after a step, are of the same point.
void RodPart::evaluate(const DaePoint& at) {
  if (is_evaluated(at)) return;
  y_ = at.y;
  rate_ = at.rate;
  take_unknowns(at.y);
  trial_.state.q = band_;
  set_mounts(at.y, trial_);
  forces_.evaluate(model_, at, trial_, {assembly_, by_curvature_, losses_});
}

// F: x' - v, or x - X where held;   m (v' + a v) + dE/dx + dD/dv, or v;   dE/dtheta + dD/dtheta', or theta;
//    dE/dk of higher order;   z' less the strands' answer.
void RodPart::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  evaluate(at);
  const double mass_rate = model_.damping().mass_rate;
  for (int i = 0; i < vertices(); ++i) {
    const SpatialEnd& end = i == 0 ? model_.properties().left : model_.properties().right;
    const double inertia = model_.inertia_of(i), drag = mass_rate * mass_of(i);
    for (int k = 0; k < 3; ++k) {
      const int x = position_of(i) + k;
      const int v = velocity_of(i) + k;
      if (is_held(i, k)) {
        rows[x] += at.y[x] - end.position[k];
        rows[v] += at.y[v];
      } else {
        rows[x] += at.rate[x] - at.y[v];
        rows[v] += inertia * at.rate[v] + drag * at.y[v] + assembly_.gradient[RodModel::block * i + k];
      }
    }
    rows[angle_of(i)] +=
        model_.holds_angle(i) ? at.y[angle_of(i)] : assembly_.gradient[RodModel::block * i + RodModel::angle];
    if (model_.is_curved()) rows.segment<2>(model_.curvature_of(i)) += by_curvature_.col(i);
    if (model_.strands().act()) {
      rows.segment<2>(strand_of(i)) += at.rate.segment<2>(strand_of(i)) - losses_.strand_rates[base::at(i)];
    }
  }
  if (model_.spin_drag() > 0.0) rows[angle_of(0)] += model_.spin_drag() * at.rate[angle_of(0)];
}

void RodPart::jacobian(const DaePoint& at, double c, std::vector<double>& values) {
  evaluate(at);
  const int bands = model_.bands();
  // What is held: 1 for x and v, or theta. Else x' - v: (c, -1), and m v' + a m v: m (c + a).
  for (int i = 0; i < bands; ++i) {
    const RodSlots::Diagonal& d = slots_.diagonal(i);
    if (RodModel::is_angle(i)) {
      if (model_.is_held(i)) RodSlots::add_to(values, d.place, 1.0);
    } else if (model_.is_held(i)) {
      RodSlots::add_to(values, d.place, 1.0);
      RodSlots::add_to(values, d.velocity, 1.0);
    } else {
      RodSlots::add_to(values, d.place, c);
      RodSlots::add_to(values, d.place_by_velocity, -1.0);
      RodSlots::add_to(values, d.velocity,
                       c * model_.inertia_of(i / RodModel::block) +
                           model_.damping().mass_rate * mass_of(i / RodModel::block));
    }
  }
  stiffness_.add(model_, {forces_.rows(), trial_, at, c}, values);
  for (const End which : ends) {
    const SpatialEnd& end = model_.properties().end(which);
    const int row = RodModel::block * model_.vertex_at(which);
    if (end.gives()) slots_.add_place(row, row, end.translational_stiffness, values);
  }
  if (model_.spin_drag() > 0.0)
    RodSlots::add_to(values, slots_.diagonal(RodModel::angle).place, c * model_.spin_drag());  // theta_0
  add_losses_jacobian(at, c, values);
}

// Of the strands, and of what the ends damp.
void RodPart::add_losses_jacobian(const DaePoint& at, double c, std::vector<double>& values) {
  for (int i = 0; i < vertices(); ++i) {
    const bool damps = model_.damping().bending_time > 0.0 && model_.end_of(i);
    if (!BendingCell::exists(model_, i)) {
      if (model_.strands().act()) add_resting_strands_jacobian(model_, i, c, slots_, values);
    } else if (damps || model_.strands().act()) {
      const BendingCell cell(model_, trial_, at, i);
      if (model_.strands().act()) add_strands_jacobian(model_, cell, i, at, c, slots_, values);
      if (damps) add_bending_damping_jacobian(model_, cell, i, c, slots_, values);
    }
  }
}

Vector3d RodPart::mount_moment(const DaePoint& at, End end) {
  trial_.spin[index_of(end)] = carried_[index_of(end)](at.y).angular;
  return wire::mount_moment(model_, trial_, at, end);
}

MountCell RodPart::mount_cell(const DaePoint& at, End end) {
  evaluate(at);
  return wire::mount_cell(model_, trial_, at, end);
}

void RodPart::accept(const DaePoint& at) {
  if (is_evaluated(at)) {
    accepted_.state = trial_.state;
    accepted_.spin = trial_.spin;
    forces_.take_frames(accepted_);
    return;
  }
  take_unknowns(at.y);
  set_mounts(at.y, accepted_);
  wire::accept(accepted_.state, band_);
  forces_.take_frames(accepted_);
}

void RodPart::begin_from_accepted() {
  trial_ = accepted_;
  y_.resize(0);
  forces_.take_frames(accepted_);
}

void RodPart::save_state(std::vector<double>& memory) const {
  for (const Frame& f : accepted_.state.frames) {
    for (int k = 0; k < 3; ++k) memory.push_back(f.tangent[k]);
    for (int k = 0; k < 3; ++k) memory.push_back(f.director[k]);
  }
  const std::vector<double>& twist = accepted_.state.reference_twist;
  memory.insert(memory.end(), twist.begin(), twist.end());
}

void RodPart::restore_state(const numerics::VectorView& y, std::span<const double>& memory) {
  take_unknowns(y);
  accepted_.state = rod().make_state(band_, model_.controls());
  for (Frame& f : accepted_.state.frames) {
    for (int k = 0; k < 3; ++k) f.tangent[k] = numerics::take(memory);
    for (int k = 0; k < 3; ++k) f.director[k] = numerics::take(memory);
  }
  for (double& m : accepted_.state.reference_twist) m = numerics::take(memory);
  accepted_.take_edges();
  begin_from_accepted();
}

double RodPart::mount_error(const numerics::VectorView& y) const {
  double worst = 0.0;
  for (const End end : ends) {
    const int i = model_.vertex_at(end);
    const Vector3d& position = model_.properties().end(end).position;
    for (int k = 0; k < 3; ++k) {
      if (is_held(i, k)) worst = std::max(worst, std::abs(y[position_of(i) + k] - position[k]));
    }
  }
  return worst;
}

RodPart::SectionLoads RodPart::section_loads(const DaePoint& at) {
  evaluate(at);
  const SpatialState& state = trial_.state;
  SectionLoads loads{Eigen::VectorXd::Zero(model_.edges()), Eigen::VectorXd::Zero(vertices())};
  for (int e = 0; e < model_.edges(); ++e) loads.tensions[e] = forces_.rows().row(RodRow::tension)[e];
  if (model_.is_curved()) {
    for (int i = 0; i < vertices(); ++i) loads.bending_moments[i] = curved_moments(model_, at, i).norm();
    return loads;
  }
  const auto tangent = [&state](int e) { return state.frames[base::at(e)].tangent; };
  const Matrix3Xd moments = rod().moments(state);
  for (int i = 0; i < vertices(); ++i) {
    const Vector3d along =
        (tangent(std::max(i - 1, 0)) + tangent(std::min(i, model_.edges() - 1))).normalized();
    loads.bending_moments[i] = (moments.col(i) - along * along.dot(moments.col(i))).norm();
  }
  return loads;
}

RodPart::LeftOut RodPart::left_out(const numerics::VectorView& y) const {
  LeftOut sum;
  for (int i = 0; i < vertices(); ++i) {
    const double mass = mass_of(i) - model_.inertia_of(i);
    const Vector3d v = y.segment<3>(velocity_of(i));
    sum.kinetic += 0.5 * mass * v.squaredNorm();
    sum.momentum += mass * v;
  }
  return sum;
}

RodPart::Energies RodPart::energies(const DaePoint& at) {
  evaluate(at);
  const SpatialState& state = trial_.state;
  const Vector3d& weight = model_.properties().weight;
  Energies result;
  double square = 0.0;
  for (int i = 0; i < vertices(); ++i) {
    const Vector3d v = at.y.segment<3>(velocity_of(i));
    square += mass_of(i) * v.squaredNorm();
    result.momentum += mass_of(i) * v;
    result.angular_momentum += mass_of(i) * vertex(state, i).cross(v);
  }
  result.drag = model_.damping().mass_rate * result.momentum;
  result.drag_moment = model_.damping().mass_rate * result.angular_momentum;
  for (int e = 0; e < model_.edges(); ++e) {
    result.potential -= 0.5 * model_.rest_length(e) * weight.dot(vertex(state, e) + vertex(state, e + 1));
  }
  const double share = model_.inertial_share();
  result.kinetic = 0.5 * share * square;
  result.momentum *= share;
  result.angular_momentum *= share;
  result.strain = assembly_.energy - result.potential + losses_.strand_energy;
  result.dissipation = losses_.power + model_.damping().mass_rate * square;
  for (int i = 0; weight != Vector3d::Zero() && i < vertices(); ++i) {
    // Half the weight of each edge is at its ends, as the mass is.
    result.weight_moment += mass_of(i) / constants().mass_per_length * vertex(state, i).cross(weight);
  }
  // Mounts that stand still: the gradient that is left at a held vertex, or the spring's force -k (x - X) of
  // one that gives.
  std::array<Vector3d, 2> moments = rod().end_moments(state);
  if (model_.is_curved()) {
    for (const End which : ends) moments[index_of(which)] += curved_end_moment(model_, trial_, at, which);
  }
  for (const End which : ends) {
    const std::size_t side = index_of(which);
    const SpatialEnd& end = model_.properties().end(which);
    if (end.kind == SpatialEnd::Kind::free || is_carried(which)) continue;
    const int i = model_.vertex_at(which);
    result.mount_forces[side] = assembly_.gradient.segment<3>(RodModel::block * i);
    if (!is_held(i, 0)) {
      result.mount_forces[side].x() =
          -end.translational_stiffness * (at.y[position_of(i)] - end.position.x());
    }
    result.mount_moments[side] = vertex(state, i).cross(result.mount_forces[side]) + losses_.couples[side] +
                                 (which == End::left ? Vector3d(-moments[side]) : moments[side]);
  }
  return result;
}

}  // namespace snare::wire
