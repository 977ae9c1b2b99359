#include "identification/parameter.hpp"

#include "numerics/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <mutex>
#include <numbers>

namespace snare::identification {

namespace {

using coupling::PushTest;

constexpr double degree = std::numbers::pi / 180.0;

double none(const PushTest&) { return 0.0; }

/// Compliance of an optional stiffness and back.
double compliance(const std::optional<double>& stiffness) { return stiffness ? 1.0 / *stiffness : 0.0; }
void set_compliance(std::optional<double>& stiffness, double value) {
  // 1e-11 m/N moves a mount by 10 nm under 1 kN: rigid, and a stiffer spring would only spoil the equations.
  if (std::abs(value) < 1e-11) stiffness.reset();
  else stiffness = 1.0 / value;
}

std::vector<Parameter> make_parameters() {
  std::vector<Parameter> all;
  const auto add = [&all](const char* key, const char* unit, double unit_size, Motion motion, auto get, auto set, auto lower,
                          auto upper, double step, double travel = 0.0) {
    Parameter p;
    p.key = key;
    p.unit = unit;
    p.unit_size = unit_size;
    p.motion = motion;
    p.get = get;
    p.set = set;
    p.lower = lower;
    p.upper = upper;
    p.step = step;
    p.travel = travel;
    all.push_back(std::move(p));
  };

  // The wire. From a rope of free hairs to twice the solid section.
  add("wire.bending_stiffness_Nm2", "N m^2", 1.0, Motion::ratio,
       [](const PushTest& t, const ReadingModel&) { return t.wire.bending_stiffness(); },
       [](PushTest& t, ReadingModel&, double v) { t.wire.bending_stiffness_override = v; },
       [](const PushTest& t) { return 1e-4 * t.wire.bending_stiffness(); },
       [](const PushTest& t) { return 5.0 * t.wire.bending_stiffness(); }, 1e-3);
  add("wire.axial_stiffness_N", "N", 1.0, Motion::ratio,
       [](const PushTest& t, const ReadingModel&) { return t.wire.axial_stiffness(); },
       [](PushTest& t, ReadingModel&, double v) { t.wire.axial_stiffness_override = v; },
       [](const PushTest& t) { return 1e-3 * t.wire.axial_stiffness(); },
       [](const PushTest& t) { return 5.0 * t.wire.axial_stiffness(); }, 1e-3);
  add("wire.length_mm", "mm", 1e-3, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return t.wire.length; },
       [](PushTest& t, ReadingModel&, double v) { t.wire.length = v; },
       [](const PushTest& t) { return 0.99 * t.mount.span; }, [](const PushTest& t) { return 1.2 * t.mount.span; },
       1e-7);
  add("wire.diameter_mm", "mm", 1e-3, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return t.wire.diameter; },
       [](PushTest& t, ReadingModel&, double v) { t.wire.diameter = v; },
       [](const PushTest& t) { return 0.5 * t.wire.diameter; }, [](const PushTest& t) { return 1.5 * t.wire.diameter; },
       1e-8);
  add("wire.youngs_modulus_GPa", "GPa", 1e9, Motion::ratio,
       [](const PushTest& t, const ReadingModel&) { return t.wire.youngs_modulus; },
       [](PushTest& t, ReadingModel&, double v) { t.wire.youngs_modulus = v; },
       [](const PushTest& t) { return 0.01 * t.wire.youngs_modulus; },
       [](const PushTest& t) { return 3.0 * t.wire.youngs_modulus; }, 1e-3);
  add("wire.density_kg_m3", "kg/m^3", 1.0, Motion::ratio,
       [](const PushTest& t, const ReadingModel&) { return t.wire.density; },
       [](PushTest& t, ReadingModel&, double v) { t.wire.density = v; },
       [](const PushTest& t) { return 0.2 * t.wire.density; }, [](const PushTest& t) { return 5.0 * t.wire.density; },
       1e-3);
  add("wire.natural_curvature_1_m", "1/m", 1.0, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return t.wire.natural_curvature; },
       [](PushTest& t, ReadingModel&, double v) { t.wire.natural_curvature = v; },
       [](const PushTest&) { return -100.0; }, [](const PushTest&) { return 100.0; }, 1e-3);

  // The mounts.
  add("mount.span_mm", "mm", 1e-3, Motion::shift, [](const PushTest& t, const ReadingModel&) { return t.mount.span; },
       [](PushTest& t, ReadingModel&, double v) { t.mount.span = v; },
       [](const PushTest& t) { return 0.8 * t.mount.span; }, [](const PushTest& t) { return t.wire.length / 0.99; },
       1e-7);
  add("mount.support_radius_mm", "mm", 1e-3, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return t.mount.support_radius; },
       [](PushTest& t, ReadingModel&, double v) { t.mount.support_radius = v; }, none,
       [](const PushTest& t) { return 0.2 * t.mount.span; }, 1e-7);
  add("mount_axial_compliance.compliance_m_N", "m/N", 1.0, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return compliance(t.mount.translational_stiffness); },
       [](PushTest& t, ReadingModel&, double v) { set_compliance(t.mount.translational_stiffness, v); }, none,
       [](const PushTest&) { return 1e-3; }, 1e-12);
  all.back().mount_gives = true;
  add("mount_rotational_compliance.compliance_rad_Nm", "rad/(N m)", 1.0, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return compliance(t.mount.rotational_stiffness); },
       [](PushTest& t, ReadingModel&, double v) { set_compliance(t.mount.rotational_stiffness, v); }, none,
       [](const PushTest&) { return 10.0; }, 1e-6);
  add("mount_slip.tension_N", "N", 1.0, Motion::magnitude,
       [](const PushTest& t, const ReadingModel&) {
         return t.mount.slip_tension.value_or(std::numeric_limits<double>::infinity());
       },
       [](PushTest& t, ReadingModel&, double v) { t.mount.slip_tension = v; },
       [](const PushTest& t) { return 1e-9 * t.wire.axial_stiffness(); },
       [](const PushTest& t) { return t.wire.axial_stiffness(); }, 1e-4);

  // The pusher.
  add("pusher.radius_mm", "mm", 1e-3, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return t.pusher.radius; },
       [](PushTest& t, ReadingModel&, double v) { t.pusher.radius = v; },
       [](const PushTest& t) { return 0.1 * t.pusher.radius; }, [](const PushTest& t) { return 10.0 * t.pusher.radius; },
       1e-7);
  add("contact_position.shift_mm", "mm", 1e-3, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return t.contact_position; },
       [](PushTest& t, ReadingModel&, double v) { t.contact_position = v; },
       [](const PushTest& t) { return 0.6 * t.contact_position; },
       [](const PushTest& t) { return t.contact_position + 0.4 * (t.mount.span - t.contact_position); }, 1e-7);
  all.back().reports_change = true;
  add("pusher.misalignment_deg", "deg", degree, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return t.pusher.misalignment; },
       [](PushTest& t, ReadingModel&, double v) { t.pusher.misalignment = v; },
       [](const PushTest&) { return -45.0 * degree; }, [](const PushTest&) { return 45.0 * degree; }, 1e-6);
  add("pusher.friction", "", 1.0, Motion::shift, [](const PushTest& t, const ReadingModel&) { return t.pusher.friction; },
       [](PushTest& t, ReadingModel&, double v) { t.pusher.friction = v; }, none, [](const PushTest&) { return 2.0; },
       1e-5);
  add("pusher.compliance_m_N", "m/N", 1.0, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return t.pusher.compliance; },
       [](PushTest& t, ReadingModel&, double v) { t.pusher.compliance = v; }, none,
       [](const PushTest&) { return 1e-3; }, 1e-10);

  // How sections slip, yield and flow; weight.
  add("strand_hysteresis.extra_stiffness_Nm2", "N m^2", 1.0, Motion::shift,
       [](const PushTest& t, const ReadingModel&) {
         return t.wire.strand_friction ? t.wire.strand_friction->extra_stiffness : 0.0;
       },
       [](PushTest& t, ReadingModel&, double v) {
         if (!t.wire.strand_friction) t.wire.strand_friction = wire::StrandFriction{0.0, 1.0};
         t.wire.strand_friction->extra_stiffness = v;
       },
       [](const PushTest& t) { return 1e-4 * t.wire.bending_stiffness(); },
       [](const PushTest& t) { return 1e3 * t.wire.bending_stiffness(); }, 1e-6);
  add("strand_hysteresis.slip_curvature_1_m", "1/m", 1.0, Motion::magnitude,
       [](const PushTest& t, const ReadingModel&) {
         return t.wire.strand_friction ? t.wire.strand_friction->slip_curvature
                                       : std::numeric_limits<double>::infinity();
       },
       [](PushTest& t, ReadingModel&, double v) {
         if (!t.wire.strand_friction) t.wire.strand_friction = wire::StrandFriction{0.0, 1.0};
         t.wire.strand_friction->slip_curvature = v;
       },
       [](const PushTest&) { return 1e-4; }, [](const PushTest&) { return 1e3; }, 1e-3);
  add("plasticity.yield_stress_MPa", "MPa", 1e6, Motion::magnitude,
       [](const PushTest& t, const ReadingModel&) {
         return t.wire.yielding ? t.wire.yielding->yield_stress : std::numeric_limits<double>::infinity();
       },
       [](PushTest& t, ReadingModel&, double v) {
         if (!t.wire.yielding) t.wire.yielding = wire::Yielding{};
         t.wire.yielding->yield_stress = v;
       },
       [](const PushTest&) { return 1e6; }, [](const PushTest& t) { return 0.5 * t.wire.youngs_modulus; }, 1e-3);
  add("plasticity.hardening_ratio", "", 1.0, Motion::shift,
       [](const PushTest& t, const ReadingModel&) {
         return t.wire.yielding ? t.wire.yielding->hardening_ratio : wire::Yielding::usual_hardening;
       },
       [](PushTest& t, ReadingModel&, double v) {
         if (t.wire.yielding) t.wire.yielding->hardening_ratio = v;
       },
       [](const PushTest&) { return 0.002; }, [](const PushTest&) { return 0.9; }, 1e-5);
  add("gravity.along_bulge_m_s2", "m/s^2", 1.0, Motion::shift,
       [](const PushTest& t, const ReadingModel&) { return t.gravity[1]; },
       [](PushTest& t, ReadingModel&, double v) { t.gravity[1] = v; }, [](const PushTest&) { return -100.0; },
       [](const PushTest&) { return 100.0; }, 1e-2);

  // The record.
  add("reading.displacement_offset_mm", "mm", 1e-3, Motion::shift,
       [](const PushTest&, const ReadingModel& r) { return r.displacement_offset; },
       [](PushTest&, ReadingModel& r, double v) { r.displacement_offset = v; },
       [](const PushTest&) { return -5e-3; }, [](const PushTest&) { return 5e-3; }, 1e-7, -1.0);
  add("reading.force_offset_N", "N", 1.0, Motion::shift,
       [](const PushTest&, const ReadingModel& r) { return r.force_offset; },
       [](PushTest&, ReadingModel& r, double v) { r.force_offset = v; }, [](const PushTest&) { return -1e3; },
       [](const PushTest&) { return 1e3; }, 1e-3);
  add("reading.force_gain", "", 1.0, Motion::ratio, [](const PushTest&, const ReadingModel& r) { return r.force_gain; },
       [](PushTest&, ReadingModel& r, double v) { r.force_gain = v; }, [](const PushTest&) { return 0.2; },
       [](const PushTest&) { return 5.0; }, 1e-3);
  add("rate_viscosity.relaxation_time_s", "s", 1.0, Motion::shift,
       [](const PushTest&, const ReadingModel& r) { return r.relaxation_time; },
       [](PushTest&, ReadingModel& r, double v) { r.relaxation_time = v; }, none, [](const PushTest&) { return 1e6; },
       1e-6);
  return all;
}

}  // namespace

double Parameter::value(double declared, double c) const {
  switch (motion) {
    case Motion::ratio: return declared * std::exp(c);
    case Motion::shift: return declared + c;
    case Motion::magnitude: return std::exp(c);
  }
  return declared;
}

double Parameter::shown(double declared, double c) const {
  return (reports_change ? c : value(declared, c)) / unit_size;
}

double Parameter::coordinate(double declared, double v) const {
  switch (motion) {
    case Motion::ratio: return std::log(v / declared);
    case Motion::shift: return v - declared;
    case Motion::magnitude: return std::log(v);
  }
  return 0.0;
}

const std::vector<Parameter>& all_parameters() {
  static const std::vector<Parameter> all = make_parameters();
  return all;
}

const Parameter* find_parameter(std::string_view key) {
  const auto find = [key](const auto& all) -> const Parameter* {
    const auto found = std::find_if(all.begin(), all.end(), [key](const Parameter& p) { return p.key == key; });
    return found == all.end() ? nullptr : &*found;
  };
  if (const Parameter* common = find(all_parameters())) return common;
  constexpr std::string_view prefix = "series[";
  const std::size_t end = key.find("].");
  if (!key.starts_with(prefix) || end == std::string_view::npos) return nullptr;
  // Numbers of single series are made when first asked for and stay.
  static std::mutex guard;
  static std::deque<Parameter> own;
  const std::lock_guard lock(guard);
  if (const Parameter* known = find(own)) return known;
  const std::string_view inner = key.substr(end + 2);
  const auto& all = all_parameters();
  const auto of_all = std::find_if(all.begin(), all.end(), [inner](const Parameter& p) { return p.key == inner; });
  if (of_all == all.end()) return nullptr;
  own.push_back(*of_all);
  own.back().key = std::string(key);
  own.back().only = std::string(key.substr(prefix.size(), end - prefix.size()));
  return &own.back();
}

const Parameter& parameter(const std::string& key) {
  if (const Parameter* found = find_parameter(key)) return *found;
  std::string known;
  for (const Parameter& p : all_parameters()) known += (known.empty() ? "" : ", ") + p.key;
  throw numerics::InputError({"", 0, "fit.free", fmt::format("\"{}\"", key), "must be one of " + known});
}

}  // namespace snare::identification
