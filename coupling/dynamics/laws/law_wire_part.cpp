#include "coupling/dynamics/laws/law_wire_part.hpp"

#include "coupling/contact/foundation.hpp"
#include "coupling/dynamics/contact/dual_frames.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace snare::coupling {

using Eigen::Vector3d;
using multibody::Wrench;
using numerics::VectorView;

namespace {

enum Frame : std::size_t { from, to, on_shaft };

/// Larger than any wire bears without breaking: a string that begins with more would have to be behind the
/// shaft.
constexpr double largest_strain = 0.02;

/// Where the chord and the shaft's axis are nearest: along the chord from the first mount, and along the
/// axis. Parallel: nowhere.
template <class S>
struct NearestOfLines {
  bool exists = false;
  S along_chord{}, along_axis{};

  NearestOfLines(const Vector3<S>& chord, const Vector3<S>& axis, const Vector3<S>& from_centre) {
    const S b = chord.dot(axis), d = chord.dot(from_centre), f = axis.dot(from_centre);
    constexpr double parallel = 1e-6;
    exists = 1.0 - value_of(b) * value_of(b) > parallel;
    if (!exists) return;
    along_chord = (b * f - d) / (1.0 - b * b);
    along_axis = (f - b * d) / (1.0 - b * b);
  }
};

/// Where the shaft's axis goes through the plane of a wire whose mounts stand still to each other.
template <class S>
struct PlaneCrossing {
  bool exists = false;
  Vector3<S> chord, push, across, axis,
      point;  ///< unit vectors in the plane, its normal, the shaft's axis; the place
  S span{}, along_axis{}, along_chord{};

  PlaneCrossing(const std::array<FrameMotion<S>, 3>& frames, const Vector3d& binormal, double side) {
    const Vector3<S> way = frames[to].p - frames[from].p;
    span = way.norm();
    chord = way / span;
    across = frames[from].R * binormal.cast<S>();
    push = chord.cross(across) * S(side);
    axis = frames[on_shaft].R.col(2);
    constexpr double flattest = 0.2;  // sine of the angle between axis and plane
    const S steep = across.dot(axis);
    exists = std::abs(value_of(steep)) > flattest;
    if (!exists) return;
    along_axis = across.dot(Vector3<S>(frames[from].p - frames[on_shaft].p)) / steep;
    point = frames[on_shaft].p + axis * along_axis;
    along_chord = chord.dot(Vector3<S>(point - frames[from].p));
    exists = value_of(along_chord) > 0.0 && value_of(along_chord) < value_of(span);
  }
};

/// A tangent from a mount, at a distance from the axis, to the shaft: t = sqrt(rho^2 - r^2), acos(r/rho), and
/// t - r acos(r/rho), whose slope is t/rho; it meets the shaft at r^2/rho along the way to the mount. A mount
/// into which the shaft is pressed, rho <= r, has none of
/// them: the string continues along the surface, and pulls at the mount itself.
template <class S>
struct Tangent {
  S length{}, over_the_arc{}, foot;
  double turn = 0.0;

  Tangent(const S& rho, double r) : foot(rho) {
    using std::sqrt;
    constexpr double grazing = 1e-6;  // of the radius: shorter tangents do not change
    const double distance = value_of(rho), square = distance * distance - r * r;
    if (!(square > 0.0)) return;
    const double t = std::sqrt(square);
    turn = std::acos(r / distance);
    foot = r * r / rho;
    over_the_arc = lifted(t - r * turn, t / distance, rho, 0.0, rho);
    length = t > grazing * r ? S(sqrt(rho * rho - r * r)) : S(t);
  }
};

}  // namespace

/// How a mount presses on the shaft.
template <class S>
struct LawWirePart::Stop {
  S normal{};                             // [N]
  Vector3<S> slide = Vector3<S>::Zero();  // of the shaft on the mount
  double energy = 0.0, lost = 0.0;        // [J], [W]; without friction
};

template <class S>
struct LawWirePart::Action {
  std::array<FrameWrench<S>, 3> wrenches;
  bool acts = false, touches = false;
  double angle = 0.0;                     // of a string, between the mounts as seen from the axis
  S depth{-1.0};                          // elongation, or x of the rod
  S tension{}, normal{};                  // [N]
  Vector3<S> point;                       // on the shaft
  Vector3<S> slide = Vector3<S>::Zero();  // of the shaft along the wire there
  S share{0.5};                           // of the way from the first mount
  double stiffness = 0.0, rate = 0.0,
         energy = 0.0;             // of the string: d(tension)/d(elongation), rate of the elongation
  double lost = 0.0;               // of a rod or a push, by damping [W]
  std::array<Stop<S>, 2> stops{};  // at the mounts of a string, by their frames
};

LawWirePart::LawWirePart(const LawWire& wire, MovingFrame from, MovingFrame to, MovingFrame shaft)
    : UnilateralForcePart({std::move(from), std::move(to), std::move(shaft)}),
      wire_(wire),
      binormal_(wire.bulge.cross(wire.p_to - wire.p_from).normalized()),
      stop_stiffness_(wire.axial_stiffness / (wire.shaft.radius + wire.radius)),
      stop_(power_law(stop_stiffness_, 1.0, ElasticFoundation{}.damping * stop_stiffness_, 1.0)) {}

// Friction on the shaft and, shared by the carriers of the mounts, against it: all at the point of contact.
namespace {

template <class S>
void add_friction(std::array<FrameWrench<S>, 3>& wrenches, const std::array<FrameMotion<S>, 3>& frames,
                  const Vector3<S>& point, const Vector3<S>& force, const S& share) {
  wrenches[on_shaft].add(frames[on_shaft], point, force);
  wrenches[from].add(frames[from], point, -force * (S(1.0) - share));
  wrenches[to].add(frames[to], point, -force * share);
}

// The velocity that friction works against: of the shaft across a unit vector n, against what carries the
// mounts, by their shares.
template <class S>
Vector3<S> slide_at(const std::array<FrameMotion<S>, 3>& frames, const Vector3<S>& point, const S& share,
                    const Vector3<S>& n) {
  const Vector3<S> v = frames[on_shaft].velocity_at(point) -
                       frames[from].velocity_at(point) * (S(1.0) - share) -
                       frames[to].velocity_at(point) * share;
  return v - n * n.dot(v);
}

}  // namespace

// F = k d (1 + a d'), d = r - rho, along the line from the axis to the mount.
template <class S>
LawWirePart::Stop<S> LawWirePart::stop(const std::array<FrameMotion<S>, 3>& frames, std::size_t mount,
                                       Action<S>& a) const {
  Stop<S> s;
  const Vector3<S> axis = frames[on_shaft].R.col(2);
  Vector3<S> out = frames[mount].p - frames[on_shaft].p;
  out -= axis * axis.dot(out);
  const S rho = out.norm();
  const S depth = S(wire_.shaft.radius + wire_.radius) - rho;
  if (!(value_of(depth) > 0.0 && value_of(rho) > 0.0)) return s;
  const Vector3<S> n = out / rho;
  const Vector3<S> v = frames[on_shaft].velocity_at(frames[mount].p) - frames[mount].linear;
  const S rate = n.dot(v);
  const Vector3d law = stop_(value_of(depth), value_of(rate));
  s.normal = lifted(law.x(), law.y(), depth, law.z(), rate);
  s.slide = v - n * rate;
  const double elastic = stop_stiffness_ * value_of(depth);
  s.energy = 0.5 * elastic * value_of(depth);
  s.lost = (value_of(s.normal) - elastic) * value_of(rate);
  const Vector3<S> force = smooth_friction(wire_.friction, s.slide, s.normal) - n * s.normal;
  a.wrenches[on_shaft].add(frames[on_shaft], frames[mount].p, force);
  a.wrenches[mount].add(frames[mount], frames[mount].p, -force);
  a.acts = true;
  return s;
}

// A string round a cylinder unrolls to a straight line: in the plane across the axis two tangents t_k =
// sqrt(rho_k^2 - r^2) and an arc r phi, phi = Phi - acos(r/rho_1) - acos(r/rho_2), Phi the angle between the
// mounts as seen from the axis on the side of the bulge; with the height h along the axis l = sqrt((t_1 + t_2
// + r phi)^2 + h^2). dl is that of the ends along the string alone.
template <class S>
LawWirePart::Action<S> LawWirePart::stretched(const std::array<FrameMotion<S>, 3>& frames) const {
  using std::atan2, std::sqrt;
  Action<S> a;
  const Vector3<S> P = frames[from].p, T = frames[to].p, c = frames[on_shaft].p;
  Vector3<S> axis = frames[on_shaft].R.col(2);
  const Vector3<S> binormal = frames[from].R * binormal_.cast<S>();
  if (value_of(axis.dot(binormal)) < 0.0) axis = -axis;
  const Vector3<S> to_p = P - c, to_t = T - c;
  const S z_p = axis.dot(to_p), z_t = axis.dot(to_t);
  const Vector3<S> p = to_p - axis * z_p, t = to_t - axis * z_t;
  const double r = wire_.shaft.radius + wire_.radius;
  const S rho_p = p.norm(), rho_t = t.norm();

  const Tangent<S> on_p(rho_p, r), on_t(rho_t, r);
  S angle = atan2(axis.dot(p.cross(t)), p.dot(t));
  constexpr double circle = 2.0 * std::numbers::pi;
  angle += circle * std::round((angle_ - value_of(angle)) / circle);  // as it has turned since the shaft came
  a.angle = value_of(angle);
  a.touches = holds_ && a.angle > on_p.turn + on_t.turn;
  Vector3<S> u_p, u_t, q_p = P,
                       q_t = T;  // pulls on the mounts, and where the string meets and leaves the shaft
  S length;
  if (a.touches) {
    const S &t_p = on_p.length, &t_t = on_t.length;
    const S flat = on_p.over_the_arc + on_t.over_the_arc + r * angle, height = z_t - z_p;
    length = sqrt(flat * flat + height * height);
    const Vector3<S> p_unit = p / rho_p, t_unit = t / rho_t;
    const S rise = height / length, along = flat / length;
    u_p = (axis.cross(p_unit) * (r / rho_p) - p_unit * (t_p / rho_p)) * along + axis * rise;
    u_t = (-axis.cross(t_unit) * (r / rho_t) - t_unit * (t_t / rho_t)) * along - axis * rise;
    q_p =
        c + p_unit * on_p.foot + axis.cross(p_unit) * (r * t_p / rho_p) + axis * (z_p + height * t_p / flat);
    q_t =
        c + t_unit * on_t.foot - axis.cross(t_unit) * (r * t_t / rho_t) + axis * (z_t - height * t_t / flat);
    a.point = (q_p + q_t) * S(0.5);
    a.share = (t_p + 0.5 * (flat - t_p - t_t)) / flat;
  } else {
    length = (T - P).norm();
    u_p = (T - P) / length;
    u_t = -u_p;
    a.point = (P + T) * S(0.5);
  }
  a.depth = length - S(wire_.length);
  if (!(value_of(a.depth) > 0.0)) return a;
  const double k = a.stiffness = wire_.axial_stiffness / wire_.length;
  S rate = -u_p.dot(frames[from].linear) - u_t.dot(frames[to].linear);
  if (a.touches)
    rate += u_p.dot(frames[on_shaft].velocity_at(q_p)) + u_t.dot(frames[on_shaft].velocity_at(q_t));
  a.rate = value_of(rate);
  a.tension = k * (a.depth + wire_.axial_time * rate);
  a.energy = 0.5 * k * value_of(a.depth) * value_of(a.depth);
  if (!(value_of(a.tension) > 0.0)) {
    a.tension = S(0.0);
    return a;
  }
  a.acts = true;
  a.wrenches[from].add(frames[from], P, u_p * a.tension);
  a.wrenches[to].add(frames[to], T, u_t * a.tension);
  if (!a.touches) return a;
  a.wrenches[on_shaft].add(frames[on_shaft], q_p, -u_p * a.tension);
  a.wrenches[on_shaft].add(frames[on_shaft], q_t, -u_t * a.tension);
  const Vector3<S> press = -(u_p + u_t) * a.tension;
  a.normal = press.norm();
  if (!(value_of(a.normal) > 0.0)) return a;
  const Vector3<S> n = press / a.normal;
  a.slide = slide_at(frames, a.point, a.share, n);
  add_friction(a.wrenches, frames, a.point, smooth_friction(wire_.friction, a.slide, a.normal), a.share);
  return a;
}

// The rod points from its pivot to the other mount; the shaft, a circle of radius r at the distance rho from
// the pivot, lets it turn up to the tangent: x = l (asin(delta/rho) + asin(r/rho)), l = sqrt(rho^2 - r^2),
// delta the axis' distance behind the rod. All forces together do the work of F dx: across the rod F
// dx/ddelta, along it F dx/ds on whatever moves the place s of the shaft.
template <class S>
LawWirePart::Action<S> LawWirePart::rod(const std::array<FrameMotion<S>, 3>& frames) const {
  using std::asin, std::sqrt;
  Action<S> a;
  const Vector3<S> P = frames[from].p, T = frames[to].p, c = frames[on_shaft].p;
  const S span = (T - P).norm();
  const Vector3<S> e = (T - P) / span;
  a.point = (P + T) * S(0.5);
  Vector3<S> axis = frames[on_shaft].R.col(2);
  if (value_of(axis.dot(frames[from].R * binormal_.cast<S>())) < 0.0) axis = -axis;
  const NearestOfLines<S> near(e, axis, P - c);
  if (!holds_ || !near.exists) return a;
  const S& s = near.along_chord;
  if (!(value_of(s) > 0.0 && value_of(s) < value_of(span))) return a;
  const Vector3<S> n = Vector3<S>(e.cross(axis)).normalized();
  const S behind = n.dot(c - P);
  const double r = wire_.shaft.radius + wire_.radius;
  const S rho = sqrt(s * s + behind * behind);
  if (!(value_of(rho) > r)) return a;
  const S tangent = sqrt(rho * rho - r * r), turn = asin(behind / rho) + asin(r / rho);
  a.depth = tangent * turn;
  a.touches = value_of(a.depth) > 0.0;
  a.point = P + e * s;
  a.share = s / span;
  if (!a.touches) return a;
  const S& share = a.share;
  // x' = x_delta delta' + x_s s': how the shaft moves across the rod, and along it.
  const S across = behind / tangent * turn + (s * tangent - r * behind) / (rho * rho);
  const S along = s / tangent * turn - (behind * tangent + r * s) / (rho * rho);
  const S cosine = e.dot(axis), square = 1.0 - cosine * cosine;
  const Vector3<S> u = (e - axis * cosine) / square, q = c + axis * near.along_axis;
  const S lean = behind / square / span;                                // of s by the turn of the rod
  const Vector3<S> tilt = axis.cross(n) * (-behind * cosine / square);  // and by that of the shaft
  const auto between = [&](const Vector3<S>& at) {
    return Vector3<S>(frames[on_shaft].velocity_at(at) - frames[from].linear * (S(1.0) - share) -
                      frames[to].linear * share);
  };
  const Vector3<S> parting = frames[to].linear - frames[from].linear;
  const S shift =
      u.dot(between(q)) + lean * n.dot(parting) + share * e.dot(parting) + tilt.dot(frames[on_shaft].angular);
  const S speed = across * n.dot(between(a.point)) + along * shift;
  const Vector3d law = wire_.law(value_of(a.depth), value_of(speed));
  const S force = lifted(law.x(), law.y(), a.depth, law.z(), speed);
  a.energy = wire_.law.energy(value_of(a.depth));
  a.lost = (law.x() - wire_.law.elastic(value_of(a.depth)).x()) * value_of(speed);
  if (!(value_of(force) > 0.0)) return a;
  a.acts = true;
  a.normal = force * across;
  const S y = a.depth + S(wire_.standoff);
  a.tension = force / (y / sqrt(s * s + y * y) + y / sqrt((span - s) * (span - s) + y * y));
  const Vector3<S> sideways = u * (force * along), leaning = (n * lean + e * share) * (force * along);
  a.wrenches[on_shaft].add(frames[on_shaft], a.point, -n * a.normal);
  a.wrenches[on_shaft].add(frames[on_shaft], q, -sideways);
  a.wrenches[on_shaft].moment -= tilt * (force * along);
  a.wrenches[from].add(frames[from], P,
                       n * a.normal * (S(1.0) - share) + sideways * (S(1.0) - share) + leaning);
  a.wrenches[to].add(frames[to], T, n * a.normal * share + sideways * share - leaning);
  a.slide = slide_at(frames, a.point, share, n);
  add_friction(a.wrenches, frames, a.point, smooth_friction(wire_.friction, a.slide, a.normal), share);
  return a;
}

// A shift dx of the shaft's material at q, where the axis a goes through the plane of normal m, moves that
// place by dx - a (m.dx)/(m.a): the law's force g, in the plane, is the force g - m (g.a)/(m.a) on the
// material, across the axis.
template <class S>
LawWirePart::Action<S> LawWirePart::push(const std::array<FrameMotion<S>, 3>& frames) const {
  using std::sqrt;
  Action<S> a;
  const PlaneCrossing<S> on(frames, binormal_, wire_.side);
  a.point = (frames[from].p + frames[to].p) * S(0.5);
  if (!holds_ || !on.exists) return a;
  const S height = on.push.dot(Vector3<S>(on.point - frames[from].p));
  const Vector3<S> v = frames[on_shaft].velocity_at(on.point) - frames[from].velocity_at(on.point);
  const S steep = on.across.dot(on.axis);
  const S rate = on.push.dot(v) - on.push.dot(on.axis) * on.across.dot(v) / steep;
  const WirePush law = wire_.push({value_of(on.along_chord), value_of(height)}, value_of(rate));
  a.depth = height + S(law.depth - value_of(height));
  a.touches = law.depth > 0.0;
  a.point = on.point;
  a.share = on.along_chord / on.span;
  if (!a.touches) return a;
  a.energy = law.energy;  // stored and lost also where the force is cut off at zero
  a.lost = law.lost;
  if (law.force.isZero(0.0)) return a;
  a.acts = true;
  const auto along = [&](Eigen::Index k) {
    const S by_place = lifted(law.force[k], law.by_place(k, 0), on.along_chord, law.by_place(k, 1), height);
    return S(by_place + lifted(0.0, law.by_rate[k], rate, 0.0, rate));
  };
  const Vector3<S> g = on.chord * along(0) + on.push * along(1);
  const Vector3<S> force = g - on.across * (g.dot(on.axis) / steep);
  a.normal = force.norm();
  add_friction(a.wrenches, frames, a.point, Vector3<S>(-force), a.share);
  const double h = std::abs(value_of(height)), s = value_of(on.along_chord), span = value_of(on.span);
  constexpr double flat = 1e-3;  // of the span: two straight pieces that say nothing of a tension
  if (h > flat * span) a.tension = a.normal / S(h / std::hypot(s, h) + h / std::hypot(span - s, h));
  a.slide = v - force * (force.dot(v) / force.squaredNorm());
  add_friction(a.wrenches, frames, a.point, smooth_friction(wire_.friction, a.slide, a.normal), a.share);
  return a;
}

template <class S>
LawWirePart::Action<S> LawWirePart::act(const std::array<FrameMotion<S>, 3>& frames) const {
  if (wire_.kind == LawWire::Kind::push) return push(frames);
  if (wire_.kind == LawWire::Kind::rod) return rod(frames);
  Action<S> a = stretched(frames);
  if (within_)
    for (const std::size_t mount : {from, to}) a.stops[mount] = stop(frames, mount, a);
  return a;
}

LawWirePart::Action<double> LawWirePart::now(const VectorView& y) const {
  return act(motions<3>(frames(), y));
}

std::vector<Wrench> LawWirePart::wrenches(const VectorView& y) const {
  const Action<double> a = now(y);
  return a.acts ? plain(a.wrenches) : std::vector<Wrench>{};
}

Eigen::MatrixXd LawWirePart::derivatives(const VectorView& y) const {
  const std::array<FrameMotion<double>, 3> frames = motions<3>(this->frames(), y);
  if (wire_.kind == LawWire::Kind::push) {  // the plane turns with what carries the mounts
    using Variables = FrameVariables<3>;
    return derivatives_of<Variables>(act(with_derivatives<Variables>(frames)).wrenches);
  }
  using Variables = FrameVariables<3, 1>;  // mounts are points
  return derivatives_of<Variables>(act(with_derivatives<Variables>(frames)).wrenches);
}

double LawWirePart::depth(const VectorView& y) const {
  return now(y).depth;
}

UnilateralForcePart::Pressing LawWirePart::pressing(const VectorView& y) const {
  const std::array<FrameMotion<double>, 3> frames = motions<3>(this->frames(), y);
  const Action<double> a = act(frames);
  Pressing p;
  p.sample.normal_force = a.normal;
  for (const Stop<double>& s : a.stops) p.sample.normal_force += s.normal;
  p.sample.closed = p.sample.normal_force > 0.0;
  if (p.sample.closed) p.sample.force = -a.wrenches[on_shaft].force;
  p.sample.point = a.point;
  p.sample.arc = a.share * wire_.length;
  p.sample.slip_speed = a.slide.norm();
  p.tension = a.tension;
  if (a.acts) p.work.wrenches = plain(a.wrenches);
  const auto by_friction = [&](const Vector3d& slide, double normal) {
    return -smooth_friction(wire_.friction, slide, normal).dot(slide);
  };
  p.work.power = {a.energy, a.lost + by_friction(a.slide, a.normal)};
  if (wire_.kind != LawWire::Kind::stretched) return p;
  p.work.power.lost += (a.tension - a.stiffness * std::max(0.0, a.depth)) * a.rate;
  for (const Stop<double>& s : a.stops) {
    p.work.power.energy += s.energy;
    p.work.power.lost += s.lost + by_friction(s.slide, s.normal);
  }
  return p;
}

LawWirePart::Shape LawWirePart::shape(const VectorView& y) const {
  const std::array<FrameMotion<double>, 3> frames = motions<3>(this->frames(), y);
  const Action<double> a = act(frames);
  Shape shape;
  shape.points.resize(3, 3);
  shape.points << frames[from].p, a.point, frames[to].p;
  for (std::size_t k = 0; k < 2; ++k) shape.mount_forces[k] = -a.wrenches[k].force;
  shape.tension = a.tension;
  return shape;
}

bool LawWirePart::reaches(const std::array<FrameMotion<double>, 3>& frames) const {
  if (wire_.kind == LawWire::Kind::push) {
    const PlaneCrossing<double> on(frames, binormal_, wire_.side);
    return on.exists && std::abs(on.along_axis) <= wire_.shaft.half_length;
  }
  const Vector3d chord = (frames[to].p - frames[from].p).normalized();
  const NearestOfLines<double> near(chord, frames[on_shaft].R.col(2), frames[from].p - frames[on_shaft].p);
  return near.exists && std::abs(near.along_axis) <= wire_.shaft.half_length;
}

void LawWirePart::update_candidates(const VectorView& y) {
  const std::array<FrameMotion<double>, 3> now = motions<3>(frames(), y);
  const double held = holds_ ? act(now).energy : 0.0;  // the shaft slides off beyond its end
  const bool was_within = std::exchange(within_, reaches(now));
  if (!within_) {
    let_go_ += held;
    holds_ = false;
  } else if (!was_within) {
    holds_ = true;
    angle_ = std::numbers::pi;
    const double depth = act(now).depth;
    holds_ = depth <=
             (wire_.kind == LawWire::Kind::stretched ? largest_strain * wire_.length : wire_.shaft.radius);
  }
  if (holds_) angle_ = act(now).angle;
}

void LawWirePart::save_state(std::vector<double>& memory) const {
  memory.push_back(within_ ? 1.0 : 0.0);
  memory.push_back(holds_ ? 1.0 : 0.0);
  memory.insert(memory.end(), {angle_, let_go_});
}

void LawWirePart::restore_state(const VectorView& /*y*/, std::span<const double>& memory) {
  within_ = numerics::take(memory) != 0.0;
  holds_ = numerics::take(memory) != 0.0;
  angle_ = numerics::take(memory);
  let_go_ = numerics::take(memory);
}

}  // namespace snare::coupling
