#include "scenario/push_law.hpp"

#include "base/archive.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "base/units.hpp"
#include "coupling/contact/push_energy.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "scenario/contact_law_reader.hpp"
#include "scenario/push_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace snare::scenario {

using base::Choice;
using base::mm;
using base::Range;
using base::TomlTable;
using coupling::WirePush;
using Eigen::Vector2d;

namespace {

constexpr double same_wire = 1e-6;  // of a number of the wire of which a table was distilled

struct NamedLaw {
  std::string_view model, table;
  std::optional<LawModel> law;
};
constexpr NamedLaw named_laws[] = {
    {"table", "table", {}},
    {"quadratic", "quadratic", LawModel::quadratic},
    {"spring_dashpot", "spring_dashpot", LawModel::spring_dashpot},
    {"power", "power", LawModel::power},
    {"step_damped", "step_damped", LawModel::step_damped},
    {"stretched_wire", "stretched_wire", LawModel::stretched_wire},
    {"stretched_wire_linear", "stretched_wire", LawModel::stretched_wire_linear}};

double read_side(const TomlTable& table) {
  static constexpr Choice<double> sides[] = {{"outward", 1.0}, {"inward", -1.0}};
  return table.has("direction") ? table.choice("direction", sides).value_or(1.0) : 1.0;
}

int read_case(const TomlTable& table) {
  return table.integer_or("case", 1, 1, 100000);
}

/// The law of one case of a law.json.
std::shared_ptr<const DistilledLaw> read_table(const TomlTable& table, const BesideScenario& beside) {
  const std::string name = table.text("file");
  const int number = read_case(table);
  if (name.empty()) return nullptr;
  try {
    std::vector<DistilledLaw> laws = read_law_file(beside.folder / name);
    if (static_cast<std::size_t>(number) > laws.size()) {
      table.fail("case", fmt::format("must be at most {}: {} has no more", laws.size(), name));
      return nullptr;
    }
    constexpr std::size_t largest = 1u << 30u;  // [byte]
    beside.input += fmt::format("{:x};", base::fingerprint(base::read_text(beside.folder / name, largest)));
    return std::make_shared<const DistilledLaw>(std::move(laws[static_cast<std::size_t>(number - 1)]));
  } catch (const base::InputError& error) {
    for (const base::InputProblem& problem : error.problems()) table.fail("file", problem.message());
  }
  return nullptr;
}

}  // namespace

const std::vector<PushModelName>& push_models() {
  static const std::vector<PushModelName> names = [] {
    std::vector<PushModelName> list;
    for (const NamedLaw& kind : named_laws) list.push_back({kind.model, kind.table});
    return list;
  }();
  return names;
}

std::optional<PushModel> read_push_model(const TomlTable& wire, std::string_view model,
                                         const BesideScenario& beside) {
  const NamedLaw& kind = *std::ranges::find(named_laws, model, &NamedLaw::model);
  const TomlTable table = wire.table(kind.table);
  PushModel push;
  push.side = read_side(table);
  if (!kind.law) {
    push.table = read_table(table, beside);
    return push.table ? std::optional(push) : std::nullopt;
  }
  push.position = table.number("position_mm", Range::above(0.0, 1e5), mm);
  push.law = read_contact_law(table, *kind.law);
  return push.law && push.position > 0.0 ? std::optional(push) : std::nullopt;
}

void read_numbers(const TomlTable& wire, std::string_view model) {
  const NamedLaw& kind = *std::ranges::find(named_laws, model, &NamedLaw::model);
  const TomlTable table = wire.table(kind.table);
  static_cast<void>(read_side(table));
  if (!kind.law) {
    static_cast<void>(table.text("file"));
    static_cast<void>(read_case(table));
    return;
  }
  static_cast<void>(table.number("position_mm", Range::above(0.0, 1e5), mm));
  static_cast<void>(read_contact_law(table, *kind.law));
}

void check_push_model(const PushModel& push, const wire::RodInMotion& rod, double span,
                      const TomlTable& wire) {
  if (push.law) {
    if (const auto problem = position_problem(push.position, span))
      wire.fail("model", "position_mm " + *problem);
    return;
  }
  const auto same = [&](const char* what, double value, double of_table, double unit, const char* name) {
    if (std::abs(value - of_table) <= same_wire * std::abs(of_table)) return;
    wire.fail("table",
              fmt::format("must have been distilled from this wire: its {} is {:.6g} {}, here {:.6g} {}",
                          what, of_table / unit, name, value / unit, name));
  };
  const DistilledLaw& law = *push.table;
  same("span", span, law.wire.span, mm, "mm");
  same("bending stiffness", rod.properties.bending_stiffness, law.wire.bending_stiffness, 1.0, "N m^2");
  same("axial stiffness", rod.properties.axial_stiffness, law.wire.axial_stiffness, 1.0, "N");
  const double slack = rod.length - span, margin = same_wire * span;
  if (slack < law.slack[0] - margin || slack > law.slack[1] + margin)
    wire.fail("table",
              fmt::format("must have this wire's slack of {:.6g} mm in its range, {:.6g} to {:.6g} mm",
                          slack / mm, law.slack[0] / mm, law.slack[1] / mm));
}

numerics::HermiteCurve first_touch(const Eigen::Matrix3Xd& rest, double radius, double side) {
  std::vector<double> x, height;
  for (Eigen::Index k = 0; k < rest.cols(); ++k) {
    if (k > 0 && !(rest(0, k) > x.back()))
      throw base::InputError(
          {"", 0, "wire", "",
           "must lie over its chord at rest for a law to stand for it: it has too much slack"});
    x.push_back(rest(0, k));
    height.push_back(side * rest(1, k));
  }
  const double span = x.back();
  const numerics::HermiteCurve wire(std::move(x), std::move(height));
  const int count = 4 * static_cast<int>(rest.cols());
  std::vector<double> places, touches, slopes;
  for (int i = 0; i <= count; ++i) {
    const double s = span * i / count;
    // Where the slope of the wire is that of the disc: w' + (x - s)/sqrt(R^2 - (x - s)^2) = 0 rises through
    // zero between the disc's edges.
    double low = std::max(0.0, s - radius), high = std::min(span, s + radius);
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high), from = middle - s;
      const double rise =
          wire.slope(middle) + from / std::sqrt(std::max(radius * radius - from * from, 1e-300));
      (rise < 0.0 ? low : high) = middle;
    }
    const double at = 0.5 * (low + high), from = at - s;
    const double chord = std::sqrt(std::max(radius * radius - from * from, 0.0));
    places.push_back(s);
    touches.push_back(wire.value(at) - chord);
    slopes.push_back(chord > 0.0 ? -from / chord : 0.0);
  }
  return {std::move(places), std::move(touches), std::move(slopes)};
}

void set_push_law(const PushModel& push, const wire::RodInMotion& rod, coupling::LawWire& wire) {
  const numerics::HermiteCurve touch =
      first_touch(coupling::resting_wire(rod), wire.shaft.radius + wire.radius, push.side);
  wire.side = push.side;
  if (push.law) {
    wire.push = [law = push.law, height = touch.value(push.position)](const Vector2d& place, double rate) {
      WirePush p;
      p.depth = place.y() - height;
      const Eigen::Vector3d force = law(p.depth, rate);
      p.force.y() = force.x();
      p.by_place(1, 1) = force.y();
      p.by_rate.y() = force.z();
      p.energy = law.energy(p.depth);
      p.lost = (force.x() - law.elastic(p.depth).x()) * rate;
      return p;
    };
    constexpr double shallow = 1e-12, speed = 1.0, none = 1e-9;  // [m], [m/s], [N]
    wire.push_jumps = push.law(shallow, speed).x() > none;
    return;
  }
  const double span = touch.knots().back();
  const auto energy = std::make_shared<const coupling::PushEnergy>(*push.table->loading, rod.length - span);
  // The force is minus the slope of U(y - t(s), s), t the height of the first touch.
  wire.push = [energy, touch](const Vector2d& place, double) {
    WirePush p;
    const double s = place.x(), slope = touch.slope(s);
    p.depth = place.y() - touch.value(s);
    if (!(p.depth > 0.0)) return p;
    const coupling::PushEnergy::Value u = energy->at(p.depth, s);
    p.energy = u.energy;
    p.force = {u.by_position - u.by_travel * slope, u.by_travel};
    p.by_place(0, 0) =
        u.by_positions - (2.0 * u.by_both - u.by_travels * slope) * slope - u.by_travel * touch.curvature(s);
    p.by_place(0, 1) = p.by_place(1, 0) = u.by_both - u.by_travels * slope;
    p.by_place(1, 1) = u.by_travels;
    return p;
  };
  wire.covers = [table = push.table, slack = rod.length - span](double travel, double position) {
    return table->in_range(std::max(travel, table->travel[0]), position, slack);
  };
}

}  // namespace snare::scenario
