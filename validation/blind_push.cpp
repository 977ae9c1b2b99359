#include "validation/blind_push.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "validation/blind_collocation.hpp"
#include "validation/blind_section.hpp"

namespace snare::validation {
namespace {

using blind::Collocation;
using blind::Conditions;
using blind::Grip;
using blind::Section;
using blind::Unknowns;
using Eigen::Vector2d;

void require(bool holds, const char* name, double value, const char* requirement) {
  if (holds) return;
  throw std::invalid_argument(std::string("blind wire: ") + name + " = " + std::to_string(value) +
                              ", must be " + requirement);
}

void check(const BlindWire& w) {
  const auto positive = [](const char* name, double value) {
    require(value > 0.0 && std::isfinite(value), name, value, "finite and > 0");
  };
  const auto not_negative = [](const char* name, double value) {
    require(value >= 0.0 && std::isfinite(value), name, value, "finite and >= 0");
  };
  positive("length", w.length);
  positive("span", w.span);
  positive("bending_stiffness", w.bending_stiffness);
  positive("axial_stiffness", w.axial_stiffness);
  require(w.position > 0.0 && w.position < w.span, "position", w.position, "in (0, span)");
  not_negative("radius", w.radius);
  require(w.weight.allFinite(), "weight", w.weight.norm(), "finite");
  require(std::isfinite(w.natural_curvature), "natural_curvature", w.natural_curvature, "finite");
  require(w.damage_from <= w.damage_to, "damage_from", w.damage_from, "<= damage_to");
  positive("damage_factor", w.damage_factor);
  not_negative("mount_axial_compliance", w.mount_axial_compliance);
  not_negative("mount_rotational_compliance", w.mount_rotational_compliance);
  require(w.mount_slip_tension > 0.0, "mount_slip_tension", w.mount_slip_tension, "> 0");
  require(std::abs(w.misalignment) < 1.0, "misalignment", w.misalignment, "in (-1, 1)");
  not_negative("pusher_compliance", w.pusher_compliance);
  not_negative("friction", w.friction);
  not_negative("strand_extra_stiffness", w.strand_extra_stiffness);
  not_negative("strand_slip_curvature", w.strand_slip_curvature);
  not_negative("strand_slip_breadth", w.strand_slip_breadth);
  require(w.strand_layers >= 1, "strand_layers", w.strand_layers, ">= 1");
  require(w.yield_stress > 0.0, "yield_stress", w.yield_stress, "> 0");
  if (std::isfinite(w.yield_stress)) positive("diameter", w.diameter);
  not_negative("relaxation_time", w.relaxation_time);
  require(w.intervals >= 8, "intervals", w.intervals, ">= 8");
  require(w.history_points >= 2, "history_points", w.history_points, ">= 2");
  positive("history_step", w.history_step);
  require(w.viscous_steps >= 1, "viscous_steps", w.viscous_steps, ">= 1");
}

// A point on the path: unknowns, and which of the alternatives hold. grip and feed are 0 while friction
// holds, else the sign of the motion: of S_c + R th_c, and of the pull on a slipping mount.
struct State {
  Unknowns z;
  Vector2d position = Vector2d::Zero();  // of the touched section, exact without contact only [m]
  double travel = 0.0;                   // [m]
  bool touching = false;
  int grip = 0;
  int feed = 0;
  double anchor = 0.0;  // S_c + R th_c where it began to stick [m]

  [[nodiscard]] bool same_alternatives(const State& other) const {
    return touching == other.touching && grip == other.grip && feed == other.feed;
  }
};

// What ends an alternative, each when its margin becomes positive.
enum Event : std::size_t { lose, touch, slide_forward, slide_back, pull_in, push_out, events_end };
using Margins = std::array<double, events_end>;

constexpr double kMarginTolerance = 1e-9;
constexpr double kNoMotion = 1e-8;  // of the way from reading to reading
constexpr double kNoCreep = 1e-4;   // the same of a viscous wire, whose stress jumps with the pusher's speed
constexpr double kSmallestPart = 1e-6;  // of the way from reading to reading
constexpr double kTurningPart = 1.0 / 64.0;
constexpr int kSwitches = 8;  // of alternatives in one place

class Push {
 public:
  explicit Push(const BlindWire& wire)
      : wire_((check(wire), wire)), law_(wire), solver_(wire, wire.position * wire.length / wire.span) {
    loosen();
    // Dense nodes have to stand at a damage's edges once the touched section is known.
    if (wire.damage_factor != 1.0) {
      solver_ = Collocation(wire, here_.z.contact);
      law_ = Section(wire);
      here_ = State{};
      before_.reset();
      loosen();
    }
  }

  void advance(double travel, double duration);
  [[nodiscard]] BlindReading read() const;

 private:
  [[nodiscard]] Unknowns buckled(double span, double& slack) const;
  void loosen();
  [[nodiscard]] Conditions conditions(const State& state, double travel, double rate) const;
  [[nodiscard]] double slid(const Unknowns& z) const {
    return z.contact + wire_.radius * z.section[solver_.contact_node()][0];
  }
  [[nodiscard]] double drive(const Unknowns& z) const;
  [[nodiscard]] Vector2d tangent(const Unknowns& z) const;
  [[nodiscard]] Margins margins(const State& state) const;
  [[nodiscard]] std::optional<State> attempt(double travel, double duration);
  [[nodiscard]] bool contact_turned(const State& trial) const;
  [[nodiscard]] bool mount_turned(const State& trial) const;
  void change(Event event);
  void accept(State&& state, double duration);
  [[nodiscard]] double rate(double duration) const {
    return duration > 0.0 ? wire_.relaxation_time / duration : 0.0;
  }

  struct Found {
    Event event;
    double part;
    State state;
  };
  [[nodiscard]] std::optional<Found> first_event(const State& trial, double from, double to,
                                                 double travel_from, double travel_to, double duration,
                                                 bool& failed);

  BlindWire wire_;
  Section law_;
  Collocation solver_;
  Vector2d touch_ = Vector2d::Zero();
  State here_;
  std::optional<State> before_;
};

Vector2d Push::tangent(const Unknowns& z) const {
  const double th = z.section[solver_.contact_node()][0];
  return {std::cos(th), std::sin(th)};
}

// C at the left mount, or the force on it along the chord.
double Push::drive(const Unknowns& z) const {
  if (wire_.mount_slides) return z.n.x();
  const auto& [th, M] = z.section.front();
  const double N = z.n.x() * std::cos(th) + z.n.y() * std::sin(th);
  return N + 0.5 * N * N / wire_.axial_stiffness + 0.5 * M * M / law_.stiffness(z.begin)[0];
}

// First buckled mode th = a sin(2 pi S/L) with a^2 L/4 the length to be hidden, or the straight wire.
Unknowns Push::buckled(double span, double& slack) const {
  const double L = wire_.length;
  const double wave = 2.0 * std::numbers::pi / L;
  const double stuck = wire_.strand_slip_curvature > 0.0 ? wire_.strand_extra_stiffness : 0.0;
  const double EI = wire_.bending_stiffness + stuck;
  const double P =
      EI * wave * wave / (1.0 + 2.0 * std::numbers::pi * wire_.mount_rotational_compliance * EI / L);
  slack = L * (1.0 - P / wire_.axial_stiffness) - span - 2.0 * wire_.mount_axial_compliance * P;
  Unknowns z;
  z.contact = wire_.position * L / span;
  z.section.resize(solver_.nodes());
  const double amplitude = slack > 0.0 ? 2.0 * std::sqrt(slack / L) : 0.0;
  const double stretched = (span - L) / (L / wire_.axial_stiffness + 2.0 * wire_.mount_axial_compliance);
  z.n.x() = slack > 0.0 ? -P : stretched;
  for (std::size_t i = 0; i < z.section.size(); ++i) {
    const double S = solver_.coordinate(z, i);
    z.section[i] = {amplitude * std::sin(wave * S), EI * amplitude * wave * std::cos(wave * S) +
                                                        wire_.bending_stiffness * wire_.natural_curvature};
  }
  return z;
}

// The loose wire: the mounts come together from L to the span and the weight grows with them. Curvatures grow
// in that motion, so one return mapping from the virgin wire is the path's.
void Push::loosen() {
  double part = 0.0;
  double step = 1.0;
  bool bulged = false;
  while (part < 1.0) {
    const double next = std::min(1.0, part + step);
    const double span = wire_.length + next * (wire_.span - wire_.length);
    double slack = 0.0;
    Unknowns z = buckled(span, slack);
    if (bulged) z = here_.z;
    Conditions at;
    at.span = span;
    at.weight = next * wire_.weight;
    at.pusher = {wire_.position * span / wire_.span, 0.0};
    const bool solved = solver_.solve(law_, at, z) && (slack <= 0.0 || solver_.contact_position().y() > 0.0);
    if (!solved) {
      step *= 0.5;
      if (step < 1e-3) throw std::runtime_error("blind wire: the loose shape was not found");
      continue;
    }
    here_.z = z;
    here_.position = solver_.contact_position();
    bulged = slack > 0.0;
    part = next;
  }
  const double C = drive(here_.z);
  if (std::abs(C) > wire_.mount_slip_tension) {
    here_.feed = C > 0.0 ? 1 : -1;
    Conditions at = conditions(here_, 0.0, 0.0);
    at.pusher = {wire_.position, 0.0};
    if (!solver_.solve(law_, at, here_.z)) {
      throw std::runtime_error("blind wire: the loose wire does not come to rest in the slipping mount");
    }
    here_.position = solver_.contact_position();
    here_.feed = 0;
  }
  const Vector2d t = tangent(here_.z);
  touch_ = {wire_.position, here_.position.y() - wire_.radius * t.x()};
  here_.touching = true;
  here_.anchor = slid(here_.z);
  accept(State(here_), 0.0);
}

Conditions Push::conditions(const State& state, double travel, double rate) const {
  Conditions at;
  at.span = wire_.span;
  at.weight = wire_.weight;
  at.touching = state.touching;
  at.pusher = touch_ + travel * Vector2d(std::sin(wire_.misalignment), std::cos(wire_.misalignment));
  if (wire_.friction > 0.0) {
    at.grip = state.grip == 0 ? Grip::sticking : Grip::sliding;
    at.slope = state.grip * wire_.friction;
  }
  at.anchor = state.anchor;
  at.feeding = state.feed != 0;
  if (at.feeding) at.feed_limit = state.feed * wire_.mount_slip_tension;
  at.slides = wire_.mount_slides;
  at.begin = at.slides ? state.z.place : state.z.begin;
  at.rate = rate;
  return at;
}

Margins Push::margins(const State& state) const {
  Margins margin;
  margin.fill(-1.0);
  const Vector2d t = tangent(state.z);
  const Vector2d nu(-t.y(), t.x());
  const Vector2d& f = state.z.f;
  if (state.touching) {
    const double scale = f.norm() + 1e-3 * wire_.bending_stiffness / (wire_.length * wire_.length);
    // A sticking force leaves the cone before it can pull.
    if (wire_.friction == 0.0 || state.grip != 0) {
      margin[lose] = -f.dot(nu) / scale;
    } else {
      margin[slide_forward] = (f.dot(t) - wire_.friction * f.dot(nu)) / scale;
      margin[slide_back] = (-f.dot(t) - wire_.friction * f.dot(nu)) / scale;
    }
  } else {
    const double height = touch_.y() + state.travel * std::cos(wire_.misalignment);
    margin[touch] = (height + wire_.radius * t.x() - state.position.y()) / wire_.length;
  }
  if (std::isfinite(wire_.mount_slip_tension) && state.feed == 0) {
    const double C = drive(state.z) / wire_.mount_slip_tension;
    margin[pull_in] = C - 1.0;
    margin[push_out] = -C - 1.0;
  }
  return margin;
}

std::optional<State> Push::attempt(double travel, double duration) {
  State trial = here_;
  trial.travel = travel;
  if (before_ && before_->same_alternatives(here_) && here_.travel != before_->travel) {
    const double ratio = (travel - here_.travel) / (here_.travel - before_->travel);
    if (ratio > 0.0 && ratio < 3.0) {
      const Unknowns& old = before_->z;
      Unknowns& z = trial.z;
      for (std::size_t i = 0; i < z.section.size(); ++i) {
        for (std::size_t k = 0; k < 2; ++k) z.section[i][k] += ratio * (z.section[i][k] - old.section[i][k]);
      }
      z.n += ratio * (z.n - old.n);
      z.f += ratio * (z.f - old.f);
      z.contact += ratio * (z.contact - old.contact);
      z.begin += ratio * (z.begin - old.begin);
      z.place += ratio * (z.place - old.place);
    }
  }
  const Conditions at = conditions(here_, travel, rate(duration));
  if (!solver_.solve(law_, at, trial.z)) {
    trial.z = here_.z;
    if (!solver_.solve(law_, at, trial.z)) return std::nullopt;
  }
  trial.position = solver_.contact_position();
  return trial;
}

// A sliding contact moves against its friction's sign; so does a slipping mount.
bool Push::contact_turned(const State& trial) const {
  return here_.touching && here_.grip * (slid(trial.z) - slid(here_.z)) < -1e-10 * wire_.length;
}

bool Push::mount_turned(const State& trial) const {
  const double came_in = wire_.mount_slides ? trial.z.place - here_.z.place : here_.z.begin - trial.z.begin;
  return here_.feed * came_in < -1e-10 * wire_.length;
}

void Push::change(Event event) {
  switch (event) {
    case lose:
      here_.touching = false;
      here_.grip = 0;
      here_.z.f.setZero();
      break;
    case touch:
      here_.touching = true;
      here_.grip = 0;
      here_.anchor = slid(here_.z);
      break;
    case slide_forward:
      here_.grip = 1;
      break;
    case slide_back:
      here_.grip = -1;
      break;
    case pull_in:
      here_.feed = 1;
      break;
    case push_out:
      here_.feed = -1;
      break;
    case events_end:
      break;
  }
}

void Push::accept(State&& state, double duration) {
  if (law_.remembers()) solver_.remember(law_, conditions(here_, state.travel, rate(duration)), state.z);
  if (state.touching && wire_.radius > 0.0 && state.z.f.norm() > 0.0) {
    const double M = state.z.section[solver_.contact_node()][1];
    const double kappa = law_.bend(M, state.z.contact, rate(duration), -1.0 / wire_.radius).strain;
    if (kappa * wire_.radius < -1.0 - 1e-9) {
      throw std::runtime_error("blind wire: bent sharper than the pusher at a travel of " +
                               std::to_string(1e3 * state.travel) + " mm");
    }
  }
  before_ = here_;
  here_ = std::move(state);
}

// The first change of alternatives between here (part `from`) and the trial (part `to`), by the Illinois
// variant of the false position on its margin. Nothing where there is none.
std::optional<Push::Found> Push::first_event(const State& trial, double from, double to, double travel_from,
                                             double travel_to, double duration, bool& failed) {
  const Margins before = margins(here_);
  const Margins after = margins(trial);
  const double still = law_.viscous() ? kNoCreep : kNoMotion;
  std::optional<Found> found;
  failed = false;
  for (std::size_t e = 0; e < events_end; ++e) {
    if (after[e] <= kMarginTolerance) continue;
    double a = from;
    double b = to;
    double margin_a = before[e];
    double margin_b = after[e];
    State state = trial;
    if (margin_a >= -kMarginTolerance) {
      state = here_;
      b = from;
    } else {
      for (int i = 0; i < 40 && std::abs(margin_b) > kMarginTolerance && b - a > 1e-10 && b - from > still;
           ++i) {
        const double x = std::clamp(b - margin_b * (b - a) / (margin_b - margin_a), a + 0.01 * (b - a),
                                    b - 0.01 * (b - a));
        const auto middle = attempt(travel_from + x * (travel_to - travel_from), (x - from) * duration);
        if (!middle) {
          failed = true;
          return std::nullopt;
        }
        const double margin = margins(*middle)[e];
        if (margin > -kMarginTolerance) {
          b = x;
          margin_b = margin;
          margin_a *= 0.5;
          state = *middle;
        } else {
          a = x;
          margin_a = margin;
          margin_b *= 0.5;
        }
      }
      // At a reversal a viscous wire's force jumps: what has to happen happens before anything moves.
      if (b - from <= still) {
        state = here_;
        b = from;
      }
    }
    if (!found || b < found->part) found = Found{static_cast<Event>(e), b, state};
  }
  return found;
}

void Push::advance(double travel, double duration) {
  const double start = here_.travel;
  const double way = std::abs(travel - start);
  double largest = 1.0;
  if (law_.remembers() && way > 0.0) largest = std::min(1.0, wire_.history_step / way);
  if (law_.viscous()) largest = std::min(largest, 1.0 / wire_.viscous_steps);
  double part = 0.0;
  double step = largest;
  bool fresh = true;
  int switches = 0;
  const auto stop = [&](const char* why) {
    throw std::runtime_error(std::string("blind wire: ") + why + " at a travel of " +
                             std::to_string(1e3 * (start + part * (travel - start))) + " mm");
  };
  while (part < 1.0) {
    const double next = part + 1.001 * step > 1.0 ? 1.0 : part + step;
    const auto trial =
        attempt(next == 1.0 ? travel : start + next * (travel - start), (next - part) * duration);
    bool failed = !trial;
    const bool contact_stops = trial && contact_turned(*trial);
    const bool mount_stops = trial && mount_turned(*trial);
    if (contact_stops || mount_stops) {
      if (fresh || next - part <= kTurningPart) {
        if (++switches > kSwitches) stop("friction finds no admissible motion");
        if (contact_stops) {
          here_.grip = 0;
          here_.anchor = slid(here_.z);
        }
        if (mount_stops) here_.feed = 0;
        continue;
      }
      failed = true;
    }
    std::optional<Found> found;
    if (!failed) found = first_event(*trial, part, next, start, travel, duration, failed);
    if (failed) {
      step = 0.5 * (next - part);
      if (step < kSmallestPart) stop("the path cannot be followed");
      continue;
    }
    fresh = false;
    if (found) {
      if (found->part > part) {
        switches = 0;
        accept(std::move(found->state), (found->part - part) * duration);
        part = found->part;
      } else if (++switches > kSwitches) {
        stop("contact and friction find no admissible state");
      }
      change(found->event);
      before_.reset();
      continue;
    }
    accept(State(*trial), (next - part) * duration);
    part = next;
    switches = 0;
    step = std::min(largest, 2.0 * step);
  }
}

BlindReading Push::read() const {
  const Unknowns& z = here_.z;
  const double th = z.section.front()[0];
  const Vector2d motion(std::sin(wire_.misalignment), std::cos(wire_.misalignment));
  BlindReading reading;
  reading.force = here_.touching ? std::max(0.0, z.f.dot(motion)) : 0.0;
  reading.tension_left = z.n.x() * std::cos(th) + z.n.y() * std::sin(th);
  const double end = z.section.back()[0];
  const Vector2d n = z.n - z.f - (wire_.length - z.begin) * wire_.weight;
  reading.tension_right = n.x() * std::cos(end) + n.y() * std::sin(end);
  reading.contact_coordinate = z.contact;
  return reading;
}

}  // namespace

namespace {

// The same wire seen from behind: its right mount is the left one.
BlindWire mirrored(BlindWire w) {
  w.mount_slips_right = false;
  w.position = w.span - w.position;
  w.weight.x() *= -1.0;
  w.misalignment *= -1.0;
  const double from = w.length - w.damage_to;
  w.damage_to = w.length - w.damage_from;
  w.damage_from = from;
  return w;
}

}  // namespace

std::vector<BlindReading> blind_push(const BlindWire& wire, const std::vector<double>& travel,
                                     const std::vector<double>& time) {
  if (wire.mount_slips_right) {
    std::vector<BlindReading> readings = blind_push(mirrored(wire), travel, time);
    for (BlindReading& r : readings) {
      std::swap(r.tension_left, r.tension_right);
      r.contact_coordinate = wire.length - r.contact_coordinate;
    }
    return readings;
  }
  const bool timed = wire.relaxation_time > 0.0;
  require(time.empty() ? !timed : time.size() == travel.size(), "number of times",
          static_cast<double>(time.size()), "that of the readings; needed with a relaxation time");
  for (std::size_t i = 0; i < travel.size(); ++i) {
    require(std::isfinite(travel[i]), "travel", travel[i], "finite");
    if (!timed) continue;
    require(i == 0 ? time[i] >= 0.0 : time[i] > time[i - 1], "time", time[i], ">= 0 and increasing");
  }
  Push push(wire);
  std::vector<BlindReading> readings;
  readings.reserve(travel.size());
  double clock = 0.0;
  for (std::size_t i = 0; i < travel.size(); ++i) {
    const double duration = timed ? time[i] - clock : 0.0;
    if (timed) clock = time[i];
    push.advance(travel[i], duration);
    readings.push_back(push.read());
  }
  return readings;
}

}  // namespace snare::validation
