#include "app/report/motion_page.hpp"

#include "app/report/motion_pictures.hpp"
#include "app/report/report_page.hpp"
#include "base/index.hpp"
#include "base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace snare::app {

namespace {

using base::at;
using base::degree;
using coupling::MotionSample;

/// A number of every sample over time.
template <class Number>
Curve time_curve(const std::string& name, int colour, const std::vector<MotionSample>& samples,
                 const Number& number) {
  Curve curve{name, {}, {}, CurveStyle::line, colour};
  for (const MotionSample& s : samples) {
    curve.x.push_back(s.time);
    curve.y.push_back(number(s));
  }
  return curve;
}

/// Balance, penetration and cost.
void add_balance(const coupling::MotionResult& r, ReportPage& page) {
  if (!r.report.usable()) page.callout(r.report.message, Tone::bad);
  page.key_figures({{"Energy of the integrator", format_significant(r.energy.integrator, 2) + " J",
                     "what the balance misses, all losses counted"},
                    {"Largest penetration", format_significant(r.largest_penetration, 2) + " m", ""},
                    {"Steps", std::to_string(r.statistics.steps), ""},
                    {"Real-time factor", format_significant(real_time_factor(r), 2), ""}});
}

void add_contacts(const FinishedMotion& run, ReportPage& page) {
  Table table{"",
              {"Contact"_code, "Peak force [N]"_number, "First touch [s]"_number, "Touches"_number,
               "Points at a time"_number}};
  const std::vector<std::string> contacts = run.asked.motion.contact_names();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Touches touches = touches_of(run.result, k);
    table.rows.push_back({contacts[k], format_significant(run.result.peak_force[k]),
                          touches.first ? format_significant(*touches.first, 6) : "never",
                          std::to_string(touches.count), std::to_string(most_points(run, k))});
  }
  if (!contacts.empty()) page.table(table);
}

/// What wires with a declared strength had to bear at most.
void add_strength(const FinishedMotion& run, ReportPage& page) {
  Table table{"Largest load of the wires against their strength",
              {"Wire"_code, "Share"_number, "Tension [N]"_number, "Bending as tension [N]"_number,
               "Along the wire [mm]"_number, "Time [s]"_number}};
  const std::vector<coupling::WireFacts> wires = run.asked.motion.wire_facts();
  for (std::size_t k = 0; k < run.result.strength.size(); ++k) {
    const coupling::WireFacts& wire = wires[k];
    const coupling::StrengthUse& use = run.result.strength[k];
    if (!std::isfinite(wire.strength.breaking_tension)) continue;
    table.rows.push_back({wire.name, format_significant(use.share), format_significant(use.tension),
                          format_significant(use.bending), format_significant(1e3 * use.arc),
                          format_significant(use.time, 6)});
    if (use.share >= 1.0)
      page.callout(fmt::format("{} would break: it bears {} of its strength at {} s", wire.name,
                               format_significant(use.share), format_significant(use.time, 6)),
                   Tone::bad);
  }
  if (!table.rows.empty()) page.table(table);
}

/// What quasi-static wires leave out.
void add_left_out(const FinishedMotion& run, ReportPage& page) {
  Table table{"Left out of the quasi-static wires: largest of what their mass would have",
              {"Wire"_code, "Kinetic energy [J]"_number, "Force of inertia [N]"_number}};
  for (std::size_t k = 0; k < run.result.left_out.size(); ++k) {
    const coupling::MotionWire& wire = run.asked.motion.wires[k];
    const coupling::LeftOutInertia& left_out = run.result.left_out[k];
    if (!wire.rod.quasi_static) continue;
    table.rows.push_back(
        {wire.name, format_significant(left_out.kinetic), format_significant(left_out.force)});
  }
  if (!table.rows.empty()) page.table(table);
}

/// Phases, first touches and tightness in their order.
std::vector<SceneMark> marks_of(const FinishedMotion& run) {
  const coupling::Motion& motion = run.asked.motion;
  std::vector<SceneMark> marks;
  for (const coupling::PhaseBeginning& p : run.result.phases)
    marks.push_back({p.time, "phase: " + motion.phases[base::at(p.phase)].name});
  const std::vector<std::string> contacts = motion.contact_names();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (const auto first = touches_of(run.result, k).first)
      marks.push_back({*first, "first touch: " + contacts[k]});
  }
  const std::vector<coupling::WireFacts> wires = motion.wire_facts();
  for (std::size_t k = 0; k < std::min(wires.size(), run.result.wires.size()); ++k) {
    if (std::isfinite(run.result.wires[k].tight_at))
      marks.push_back({run.result.wires[k].tight_at, "tight: " + wires[k].name});
  }
  std::stable_sort(marks.begin(), marks.end(),
                   [](const SceneMark& a, const SceneMark& b) { return a.time < b.time; });
  return marks;
}

void add_time_line(const std::vector<SceneMark>& marks, ReportPage& page) {
  if (marks.empty()) return;
  Table table{"What happened", {"Time [s]"_number, "What"_text}, {}};
  for (const auto& [time, what] : marks) table.rows.push_back({format_significant(time, 6), what});
  page.table(table);
}

void add_list_plots(const FinishedMotion& run, ReportPage& page) {
  const coupling::Motion& motion = run.asked.motion;
  PlotSpecification forces{"Contact forces", {"time", "s"}, {"force", "N"}};
  const std::vector<std::string> contacts = motion.contact_names();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    forces.curves.push_back(time_curve(contacts[k], static_cast<int>(k), run.samples,
                                       [k](const MotionSample& s) { return s.contacts[k].normal_force; }));
  }
  if (!contacts.empty()) page.line_plot(forces);
  const std::vector<coupling::WireFacts> wires = motion.wire_facts();
  PlotSpecification tensions{"Tension of the wires", {"time", "s"}, {"tension", "N"}};
  for (std::size_t k = 0; k < wires.size(); ++k) {
    tensions.curves.push_back(time_curve(wires[k].name, static_cast<int>(k), run.samples,
                                         [k](const MotionSample& s) { return coupling::end_tension(s, k); }));
  }
  for (std::size_t k = 0; k < wires.size(); ++k) {
    const double strength = wires[k].strength.breaking_tension;
    if (!std::isfinite(strength) || (k > 0 && strength == wires[k - 1].strength.breaking_tension)) continue;
    const Values ends{run.samples.front().time, run.samples.back().time};
    tensions.curves.push_back(make_curve("strength", ends, {strength, strength}, CurveStyle::dashes,
                                         static_cast<int>(wires.size())));
  }
  if (!wires.empty()) page.line_plot(tensions);
  if (motion.bodies.empty()) return;
  PlotSpecification speeds{"Speeds of the bodies", {"time", "s"}, {"speed", "m/s"}};
  for (std::size_t k = 0; k < motion.bodies.size(); ++k) {
    speeds.curves.push_back(time_curve(motion.bodies[k].name, static_cast<int>(k), run.samples,
                                       [k](const MotionSample& s) { return s.bodies[k].velocity.norm(); }));
  }
  page.line_plot(speeds);
}

/// Deflection of the joints of arms and snares; of those that slide in mm.
void add_joint_plots(const FinishedMotion& run, ReportPage& page) {
  const coupling::Motion& motion = run.asked.motion;
  PlotSpecification joints{"Deflection of the joints", {"time", "s"}, {"deflection", "deg"}};
  PlotSpecification torques{"Torque of the joints", {"time", "s"}, {"torque", "N m"}};
  int colour = 0;
  for (std::size_t a = 0; a < motion.arms.size(); ++a) {
    const multibody::ElasticArm& arm = motion.arms[a].arm;
    for (int j = 0; j < arm.motors(); ++j) {
      if (arm.tree.body(arm.joints[at(j)].body).joint == multibody::JointKind::prismatic) continue;
      const std::string name = motion.arms[a].joint_name(j);
      joints.curves.push_back(time_curve(name, colour, run.samples, [&arm, a, j](const MotionSample& s) {
        return multibody::deflection(arm, s.arms[a].state, j) / degree;
      }));
      torques.curves.push_back(time_curve(
          name, colour++, run.samples, [a, j](const MotionSample& s) { return s.arms[a].joint_torque[j]; }));
    }
  }
  if (joints.curves.empty()) return;
  page.line_plot(joints);
  page.line_plot(torques);
}

void add_swings(const std::vector<scenario::Swing>& swings, ReportPage& page) {
  if (swings.empty()) return;
  Table table{"Swings of the joint, from zero to zero of its deflection",
              {"Begin [s]"_number, "Peak [deg]"_number, "Frequency [Hz]"_number}};
  for (const scenario::Swing& s : swings) {
    table.rows.push_back({format_significant(s.begin, 4), format_significant(s.peak / degree),
                          format_significant(s.frequency(), 4)});
  }
  page.table(table);
}

}  // namespace

std::string motion_page(const scenario::Scenario& asked, const FinishedMotion& run,
                        const std::string& version, const std::vector<std::string>& warnings,
                        bool interrupted) {
  ReportPage page(asked.title, asked.source);
  page.doubts(warnings, interrupted);
  page.heading("Summary");
  add_balance(run.result, page);
  add_contacts(run, page);
  add_strength(run, page);
  add_left_out(run, page);
  add_swings(swings_of(asked.motions, run), page);
  const std::vector<SceneMark> marks = marks_of(run);
  add_time_line(marks, page);
  page.heading("The motion");
  page.scene(MotionPictures(run.asked.motion, run.samples, asked.motions.drawn).scene(marks));
  page.heading("Time histories");
  add_list_plots(run, page);
  add_joint_plots(run, page);
  page.footer(written_by(version, "history.csv and summary.json"));
  return page.html();
}

}  // namespace snare::app
