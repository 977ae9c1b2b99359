#include "identification/fitting/parameter.hpp"

#include "base/units.hpp"
#include "base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <mutex>
#include <numbers>

namespace snare::identification {

namespace {

using coupling::PushProblem;

using base::degree;

double none(const PushProblem&) { return 0.0; }

/// Compliance of an optional stiffness and back.
double compliance(const std::optional<double>& stiffness) { return stiffness ? 1.0 / *stiffness : 0.0; }
void set_compliance(std::optional<double>& stiffness, double value) {
  // 1e-11 m/N moves a mount by 10 nm under 1 kN: rigid, and a stiffer spring would only spoil the equations.
  if (std::abs(value) < 1e-11) stiffness.reset();
  else stiffness = 1.0 / value;
}

std::vector<Parameter> make_parameters() {
  std::vector<Parameter> all;
  const auto add = [&all](const char* key, const char* unit, double unit_size, Parametrisation parametrisation, auto get, auto set, auto lower,
                          auto upper, double step, double travel = 0.0) {
    Parameter p;
    p.key = key;
    p.unit = unit;
    p.unit_size = unit_size;
    p.parametrisation = parametrisation;
    p.get = get;
    p.set = set;
    p.lower = lower;
    p.upper = upper;
    p.step = step;
    p.travel = travel;
    all.push_back(std::move(p));
  };

  // The wire. From a rope of free hairs to twice the solid section.
  add("wire.bending_stiffness_Nm2", "N m^2", 1.0, Parametrisation::ratio,
       [](const PushProblem& t, const ReadingModel&) { return t.wire.bending_stiffness(); },
       [](PushProblem& t, ReadingModel&, double v) { t.wire.bending_stiffness_override = v; },
       [](const PushProblem& t) { return 1e-4 * t.wire.bending_stiffness(); },
       [](const PushProblem& t) { return 5.0 * t.wire.bending_stiffness(); }, 1e-3);
  add("wire.axial_stiffness_N", "N", 1.0, Parametrisation::ratio,
       [](const PushProblem& t, const ReadingModel&) { return t.wire.axial_stiffness(); },
       [](PushProblem& t, ReadingModel&, double v) { t.wire.axial_stiffness_override = v; },
       [](const PushProblem& t) { return 1e-3 * t.wire.axial_stiffness(); },
       [](const PushProblem& t) { return 5.0 * t.wire.axial_stiffness(); }, 1e-3);
  add("wire.length_mm", "mm", 1e-3, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return t.wire.length; },
       [](PushProblem& t, ReadingModel&, double v) { t.wire.length = v; },
       [](const PushProblem& t) { return 0.99 * t.mount.span; }, [](const PushProblem& t) { return 1.2 * t.mount.span; },
       1e-7);
  add("wire.diameter_mm", "mm", 1e-3, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return t.wire.diameter; },
       [](PushProblem& t, ReadingModel&, double v) { t.wire.diameter = v; },
       [](const PushProblem& t) { return 0.5 * t.wire.diameter; }, [](const PushProblem& t) { return 1.5 * t.wire.diameter; },
       1e-8);
  add("wire.youngs_modulus_GPa", "GPa", 1e9, Parametrisation::ratio,
       [](const PushProblem& t, const ReadingModel&) { return t.wire.youngs_modulus; },
       [](PushProblem& t, ReadingModel&, double v) { t.wire.youngs_modulus = v; },
       [](const PushProblem& t) { return 0.01 * t.wire.youngs_modulus; },
       [](const PushProblem& t) { return 3.0 * t.wire.youngs_modulus; }, 1e-3);
  add("wire.density_kg_m3", "kg/m^3", 1.0, Parametrisation::ratio,
       [](const PushProblem& t, const ReadingModel&) { return t.wire.density; },
       [](PushProblem& t, ReadingModel&, double v) { t.wire.density = v; },
       [](const PushProblem& t) { return 0.2 * t.wire.density; }, [](const PushProblem& t) { return 5.0 * t.wire.density; },
       1e-3);
  add("wire.natural_curvature_1_m", "1/m", 1.0, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return t.wire.natural_curvature; },
       [](PushProblem& t, ReadingModel&, double v) { t.wire.natural_curvature = v; },
       [](const PushProblem&) { return -100.0; }, [](const PushProblem&) { return 100.0; }, 1e-3);

  // The mounts.
  add("mount.span_mm", "mm", 1e-3, Parametrisation::shift, [](const PushProblem& t, const ReadingModel&) { return t.mount.span; },
       [](PushProblem& t, ReadingModel&, double v) { t.mount.span = v; },
       [](const PushProblem& t) { return 0.8 * t.mount.span; }, [](const PushProblem& t) { return t.wire.length / 0.99; },
       1e-7);
  add("mount.support_radius_mm", "mm", 1e-3, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return t.mount.support_radius; },
       [](PushProblem& t, ReadingModel&, double v) { t.mount.support_radius = v; }, none,
       [](const PushProblem& t) { return 0.2 * t.mount.span; }, 1e-7);
  add("mount_axial_compliance.compliance_m_N", "m/N", 1.0, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return compliance(t.mount.translational_stiffness); },
       [](PushProblem& t, ReadingModel&, double v) { set_compliance(t.mount.translational_stiffness, v); }, none,
       [](const PushProblem&) { return 1e-3; }, 1e-12);
  all.back().mount_gives = true;
  add("mount_rotational_compliance.compliance_rad_Nm", "rad/(N m)", 1.0, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return compliance(t.mount.rotational_stiffness); },
       [](PushProblem& t, ReadingModel&, double v) { set_compliance(t.mount.rotational_stiffness, v); }, none,
       [](const PushProblem&) { return 10.0; }, 1e-6);
  add("mount_slip.tension_N", "N", 1.0, Parametrisation::magnitude,
       [](const PushProblem& t, const ReadingModel&) {
         return t.mount.slip_tension.value_or(std::numeric_limits<double>::infinity());
       },
       [](PushProblem& t, ReadingModel&, double v) { t.mount.slip_tension = v; },
       [](const PushProblem& t) { return 1e-9 * t.wire.axial_stiffness(); },
       [](const PushProblem& t) { return t.wire.axial_stiffness(); }, 1e-4);

  // The pusher.
  add("pusher.radius_mm", "mm", 1e-3, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return t.pusher.radius; },
       [](PushProblem& t, ReadingModel&, double v) { t.pusher.radius = v; },
       [](const PushProblem& t) { return 0.1 * t.pusher.radius; }, [](const PushProblem& t) { return 10.0 * t.pusher.radius; },
       1e-7);
  add("contact_position.shift_mm", "mm", 1e-3, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return t.contact_position; },
       [](PushProblem& t, ReadingModel&, double v) { t.contact_position = v; },
       [](const PushProblem& t) { return 0.6 * t.contact_position; },
       [](const PushProblem& t) { return t.contact_position + 0.4 * (t.mount.span - t.contact_position); }, 1e-7);
  all.back().reports_change = true;
  add("pusher.misalignment_deg", "deg", degree, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return t.pusher.misalignment; },
       [](PushProblem& t, ReadingModel&, double v) { t.pusher.misalignment = v; },
       [](const PushProblem&) { return -45.0 * degree; }, [](const PushProblem&) { return 45.0 * degree; }, 1e-6);
  add("pusher.friction", "", 1.0, Parametrisation::shift, [](const PushProblem& t, const ReadingModel&) { return t.pusher.friction; },
       [](PushProblem& t, ReadingModel&, double v) { t.pusher.friction = v; }, none, [](const PushProblem&) { return 2.0; },
       1e-5);
  add("pusher.compliance_m_N", "m/N", 1.0, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return t.pusher.compliance; },
       [](PushProblem& t, ReadingModel&, double v) { t.pusher.compliance = v; }, none,
       [](const PushProblem&) { return 1e-3; }, 1e-10);

  // How sections slip, yield and flow; weight.
  add("strand_hysteresis.extra_stiffness_Nm2", "N m^2", 1.0, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) {
         return t.wire.strand_friction ? t.wire.strand_friction->extra_stiffness : 0.0;
       },
       [](PushProblem& t, ReadingModel&, double v) {
         if (!t.wire.strand_friction) t.wire.strand_friction = wire::StrandFriction{0.0, 1.0};
         t.wire.strand_friction->extra_stiffness = v;
       },
       [](const PushProblem& t) { return 1e-4 * t.wire.bending_stiffness(); },
       [](const PushProblem& t) { return 1e3 * t.wire.bending_stiffness(); }, 1e-6);
  add("strand_hysteresis.slip_curvature_1_m", "1/m", 1.0, Parametrisation::magnitude,
       [](const PushProblem& t, const ReadingModel&) {
         return t.wire.strand_friction ? t.wire.strand_friction->slip_curvature
                                       : std::numeric_limits<double>::infinity();
       },
       [](PushProblem& t, ReadingModel&, double v) {
         if (!t.wire.strand_friction) t.wire.strand_friction = wire::StrandFriction{0.0, 1.0};
         t.wire.strand_friction->slip_curvature = v;
       },
       [](const PushProblem&) { return 1e-4; }, [](const PushProblem&) { return 1e3; }, 1e-3);
  add("plasticity.yield_stress_MPa", "MPa", 1e6, Parametrisation::magnitude,
       [](const PushProblem& t, const ReadingModel&) {
         return t.wire.yielding ? t.wire.yielding->yield_stress : std::numeric_limits<double>::infinity();
       },
       [](PushProblem& t, ReadingModel&, double v) {
         if (!t.wire.yielding) t.wire.yielding = wire::Yielding{};
         t.wire.yielding->yield_stress = v;
       },
       [](const PushProblem&) { return 1e6; }, [](const PushProblem& t) { return 0.5 * t.wire.youngs_modulus; }, 1e-3);
  add("plasticity.hardening_ratio", "", 1.0, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) {
         return t.wire.yielding ? t.wire.yielding->hardening_ratio : wire::Yielding::usual_hardening;
       },
       [](PushProblem& t, ReadingModel&, double v) {
         if (t.wire.yielding) t.wire.yielding->hardening_ratio = v;
       },
       [](const PushProblem&) { return 0.002; }, [](const PushProblem&) { return 0.9; }, 1e-5);
  add("gravity.along_bulge_m_s2", "m/s^2", 1.0, Parametrisation::shift,
       [](const PushProblem& t, const ReadingModel&) { return t.gravity[1]; },
       [](PushProblem& t, ReadingModel&, double v) { t.gravity[1] = v; }, [](const PushProblem&) { return -100.0; },
       [](const PushProblem&) { return 100.0; }, 1e-2);

  // The record.
  add("reading.displacement_offset_mm", "mm", 1e-3, Parametrisation::shift,
       [](const PushProblem&, const ReadingModel& r) { return r.displacement_offset; },
       [](PushProblem&, ReadingModel& r, double v) { r.displacement_offset = v; },
       [](const PushProblem&) { return -5e-3; }, [](const PushProblem&) { return 5e-3; }, 1e-7, -1.0);
  add("reading.force_offset_N", "N", 1.0, Parametrisation::shift,
       [](const PushProblem&, const ReadingModel& r) { return r.force_offset; },
       [](PushProblem&, ReadingModel& r, double v) { r.force_offset = v; }, [](const PushProblem&) { return -1e3; },
       [](const PushProblem&) { return 1e3; }, 1e-3);
  add("reading.force_gain", "", 1.0, Parametrisation::ratio, [](const PushProblem&, const ReadingModel& r) { return r.force_gain; },
       [](PushProblem&, ReadingModel& r, double v) { r.force_gain = v; }, [](const PushProblem&) { return 0.2; },
       [](const PushProblem&) { return 5.0; }, 1e-3);
  add("rate_viscosity.relaxation_time_s", "s", 1.0, Parametrisation::shift,
       [](const PushProblem&, const ReadingModel& r) { return r.relaxation_time; },
       [](PushProblem&, ReadingModel& r, double v) { r.relaxation_time = v; }, none, [](const PushProblem&) { return 1e6; },
       1e-6);
  return all;
}

}  // namespace

double Parameter::value(double declared, double c) const {
  switch (parametrisation) {
    case Parametrisation::ratio: return declared * std::exp(c);
    case Parametrisation::shift: return declared + c;
    case Parametrisation::magnitude: return std::exp(c);
  }
  return declared;
}

double Parameter::shown(double declared, double c) const {
  return (reports_change ? c : value(declared, c)) / unit_size;
}

double Parameter::coordinate(double declared, double v) const {
  switch (parametrisation) {
    case Parametrisation::ratio: return std::log(v / declared);
    case Parametrisation::shift: return v - declared;
    case Parametrisation::magnitude: return std::log(v);
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
  throw base::InputError({"", 0, "fit.free", fmt::format("\"{}\"", key), "must be one of " + known});
}

}  // namespace snare::identification
