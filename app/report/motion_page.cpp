#include "app/report/motion_page.hpp"

#include "app/report/motion_pictures.hpp"
#include "app/report/report_page.hpp"
#include "base/index.hpp"
#include "base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace snare::app {

namespace {

using base::at;
using base::degree;
using coupling::MotionSample;
using multibody::ArmSample;

/// A number of every sample over time.
template <class Sample, class Number>
Curve time_curve(const std::string& name, int colour, const std::vector<Sample>& samples, const Number& number) {
  Curve curve{name, {}, {}, CurveStyle::line, colour};
  for (const Sample& s : samples) {
    curve.x.push_back(s.time);
    curve.y.push_back(number(s));
  }
  return curve;
}

/// The outcome of every model in one table, and what stopped early.
void add_models(const std::vector<FinishedMotion>& finished, ReportPage& page) {
  Table table{"",
              {"Model"_code, "Peak force [N]"_number, "Impulse along y [N s]"_number, "Velocity after, y [m/s]"_number,
               "Spin after, z [rad/s]"_number, "Touches"_number, "Integrator's energy [J]"_number, "Steps"_number,
               "Real-time factor"_number}};
  for (const FinishedMotion& run : finished) {
    const coupling::MotionResult& r = run.result;
    const multibody::RigidBodyState& after = run.samples.back().bodies.front();
    table.rows.push_back({run.asked.name, format_significant(r.peak_force.front()),
                          format_significant(r.impulse.front().y()), format_significant(after.velocity.y()),
                          format_significant(after.spin.z()), std::to_string(touches_of(r, 0).count),
                          format_significant(r.energy.integrator, 2), std::to_string(r.statistics.steps),
                          format_significant(real_time_factor(r))});
    if (!r.report.usable()) page.callout(run.asked.name + ": " + r.report.message, Tone::bad);
  }
  page.table(table);
}

/// Balance, penetration and cost of the only motion.
void add_balance(const coupling::MotionResult& r, ReportPage& page) {
  if (!r.report.usable()) page.callout(r.report.message, Tone::bad);
  page.key_figures({{"Energy of the integrator", format_significant(r.energy.integrator, 2) + " J",
                     "what the balance misses, all losses counted"},
                    {"Largest penetration", format_significant(r.largest_penetration, 2) + " m", ""},
                    {"Steps", std::to_string(r.statistics.steps), ""},
                    {"Real-time factor", format_significant(real_time_factor(r), 2), ""}});
}

void add_contacts(const FinishedMotion& run, ReportPage& page) {
  Table table{
      "",
      {"Contact"_code, "Peak force [N]"_number, "First touch [s]"_number, "Touches"_number, "Points at a time"_number}};
  const std::vector<std::string> contacts = run.asked.motion.contact_names();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Touches touches = touches_of(run.result, k);
    table.rows.push_back({contacts[k], format_significant(run.result.peak_force[k]),
                          touches.first ? format_significant(*touches.first, 6) : "never",
                          std::to_string(touches.count), std::to_string(most_points(run, k))});
  }
  page.table(table);
}

/// What wires with a declared strength had to bear at most.
void add_strength(const std::vector<FinishedMotion>& finished, ReportPage& page) {
  Table table{"Largest load of the wires against their strength",
              {"Model"_code, "Wire"_code, "Share"_number, "Tension [N]"_number, "Bending as tension [N]"_number,
               "Along the wire [mm]"_number, "Time [s]"_number}};
  for (const FinishedMotion& run : finished) {
    const std::vector<coupling::WireFacts> wires = run.asked.motion.wire_facts();
    for (std::size_t k = 0; k < run.result.strength.size(); ++k) {
      const coupling::WireFacts& wire = wires[k];
      const coupling::StrengthUse& use = run.result.strength[k];
      if (!std::isfinite(wire.strength.breaking_tension)) continue;
      table.rows.push_back({run.asked.name, wire.name, format_significant(use.share), format_significant(use.tension),
                            format_significant(use.bending), format_significant(1e3 * use.arc),
                            format_significant(use.time, 6)});
      if (use.share >= 1.0)
        page.callout(fmt::format("{}: {} would break: it bears {} of its strength at {} s", run.asked.name, wire.name,
                                 format_significant(use.share), format_significant(use.time, 6)),
                     Tone::bad);
    }
  }
  if (!table.rows.empty()) page.table(table);
}

/// What quasi-static wires leave out.
void add_left_out(const std::vector<FinishedMotion>& finished, ReportPage& page) {
  Table table{"Left out of the quasi-static wires: largest of what their mass would have",
              {"Model"_code, "Wire"_code, "Kinetic energy [J]"_number, "Force of inertia [N]"_number}};
  for (const FinishedMotion& run : finished) {
    for (std::size_t k = 0; k < run.result.left_out.size(); ++k) {
      const coupling::MotionWire& wire = run.asked.motion.wires[k];
      const coupling::LeftOutInertia& left_out = run.result.left_out[k];
      if (!wire.rod.quasi_static) continue;
      table.rows.push_back(
          {run.asked.name, wire.name, format_significant(left_out.kinetic), format_significant(left_out.force)});
    }
  }
  if (!table.rows.empty()) page.table(table);
}

struct ModelPlot {
  const char* title;
  Axis y;
  double (*value)(const MotionSample&);
};

double contact_force(const MotionSample& s) {
  return s.contacts.front().normal_force;
}
double velocity_along_push(const MotionSample& s) {
  return s.bodies.front().velocity.y();
}

const std::vector<ModelPlot> plots_without_arm{
    {"Contact force", {"force", "N"}, contact_force},
    {"Velocity along the push", {"velocity y", "m/s"}, velocity_along_push},
    {"Spin", {"spin z", "rad/s"}, [](const MotionSample& s) { return s.bodies.front().spin.z(); }},
    {"Place of the centre of mass",
     {"y", "mm"},
     [](const MotionSample& s) { return 1e3 * s.bodies.front().position.y(); }},
    {"Velocity along the wire",
     {"velocity x", "m/s"},
     [](const MotionSample& s) { return s.bodies.front().velocity.x(); }},
    {"Kinetic energy", {"energy", "J"}, [](const MotionSample& s) { return s.energy.kinetic; }},
};

const std::vector<ModelPlot> plots_with_arm{
    {"Contact force", {"force", "N"}, contact_force},
    {"Body's velocity along the push", {"velocity y", "m/s"}, velocity_along_push},
};

/// Every model in every plot.
void add_model_plots(const std::vector<ModelPlot>& plots, const std::vector<FinishedMotion>& finished,
                     ReportPage& page) {
  for (const ModelPlot& plot : plots) {
    PlotSpecification specification{plot.title, {"time", "s"}, plot.y};
    int colour = 0;
    for (const FinishedMotion& run : finished)
      specification.curves.push_back(time_curve(run.asked.name, colour++, run.samples, plot.value));
    page.line_plot(specification);
  }
}

void add_joint_plots(const FinishedMotion& run, ReportPage& page) {
  const coupling::Motion& motion = run.asked.motion;
  const multibody::ElasticArm& arm = motion.arms.front().arm;
  PlotSpecification joints{"Deflection of the joints: " + run.asked.name, {"time", "s"}, {"deflection", "deg"}};
  PlotSpecification motors{"Motors: " + run.asked.name, {"time", "s"}, {"angle from the start", "deg"}};
  for (int j = 0; j < arm.motors(); ++j) {
    const std::string& name = arm.joints[at(j)].name;
    joints.curves.push_back(time_curve(
        name, j, run.samples, [&motion, j](const MotionSample& s) { return joint_deflection(motion, s, j) / degree; }));
    const double start = run.samples.front().arms.front().state.motor[j];
    motors.curves.push_back(time_curve(name, j, run.samples, [j, start](const MotionSample& s) {
      return (s.arms.front().state.motor[j] - start) / degree;
    }));
  }
  page.line_plot(joints);
  page.line_plot(motors);
}

/// Phases, first touches and tightness in their order.
std::vector<SceneMark> marks_of(const FinishedMotion& run) {
  const coupling::Motion& motion = run.asked.motion;
  std::vector<SceneMark> marks;
  for (const coupling::PhaseBeginning& p : run.result.phases)
    marks.push_back({p.time, "phase: " + motion.phases[base::at(p.phase)].name});
  const std::vector<std::string> contacts = motion.contact_names();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (const auto first = touches_of(run.result, k).first) marks.push_back({*first, "first touch: " + contacts[k]});
  }
  const std::vector<coupling::WireFacts> wires = motion.wire_facts();
  for (std::size_t k = 0; k < std::min(wires.size(), run.result.wires.size()); ++k) {
    if (std::isfinite(run.result.wires[k].tight_at))
      marks.push_back({run.result.wires[k].tight_at, "tight: " + wires[k].name});
  }
  std::stable_sort(marks.begin(), marks.end(), [](const SceneMark& a, const SceneMark& b) { return a.time < b.time; });
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
    tensions.curves.push_back(
        make_curve("strength", ends, {strength, strength}, CurveStyle::dashes, static_cast<int>(wires.size())));
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

/// Bodies, wires and shapes in lists.
void add_lists(const scenario::WireMotions& motions, const FinishedMotion& run, ReportPage& page) {
  add_balance(run.result, page);
  add_contacts(run, page);
  add_strength({run}, page);
  add_left_out({run}, page);
  const std::vector<SceneMark> marks = marks_of(run);
  add_time_line(marks, page);
  page.heading("The motion");
  page.scene(MotionPictures(run.asked.motion, run.samples, motions.drawn).scene(marks));
  page.heading("Time histories");
  add_list_plots(run, page);
}

/// One body that meets one wire, with an arm or without.
void add_probe_on_wire(const scenario::Probe& probe, const std::vector<FinishedMotion>& finished, ReportPage& page) {
  const bool with_arm = !finished.empty() && !finished.front().asked.motion.arms.empty();
  add_models(finished, page);
  add_strength(finished, page);
  add_left_out(finished, page);
  page.heading("Time histories");
  add_model_plots(with_arm ? plots_with_arm : plots_without_arm, finished, page);
  if (with_arm) {
    for (const FinishedMotion& run : finished) add_joint_plots(run, page);
  }
  page.heading("The contact");
  for (const FinishedMotion& run : finished) {
    page.animation(animation_of(probe, run.asked.name, run.samples));
    if (with_arm) page.scene(MotionPictures(run.asked.motion, run.samples, {}).scene({}));
  }
}

void add_swings(const std::vector<scenario::Swing>& swings, ReportPage& page) {
  Table table{"Swings of the joint, from zero to zero of its deflection",
              {"Begin [s]"_number, "Peak [deg]"_number, "Frequency [Hz]"_number}};
  for (const scenario::Swing& s : swings) {
    table.rows.push_back(
        {format_significant(s.begin, 4), format_significant(s.peak / degree), format_significant(s.frequency(), 4)});
  }
  page.table(table);
}

}  // namespace

std::string motion_page(const scenario::Scenario& asked, const scenario::WireMotions& motions,
                        const std::vector<FinishedMotion>& finished, const std::string& version,
                        const std::vector<std::string>& warnings, bool interrupted) {
  ReportPage page(asked.title, asked.source);
  page.doubts(warnings, interrupted);
  page.heading("Summary");
  if (motions.probe)
    add_probe_on_wire(*motions.probe, finished, page);
  else
    add_lists(motions, finished.front(), page);
  page.footer(written_by(version, "history.csv and summary.json"));
  return page.html();
}

std::string arm_page(const scenario::Scenario& asked, const scenario::ArmMotion& motion, const ArmRecord& record,
                     const std::string& version) {
  const multibody::ArmHistory& history = record.history;
  ReportPage page(asked.title, asked.source);
  page.doubts({}, history.report.termination == numerics::Termination::interrupted);
  page.heading("Summary");
  if (!history.report.usable()) page.callout(history.report.message, Tone::bad);
  page.key_figures(
      {{"Steps", std::to_string(history.statistics.steps), fmt::format("{} events", history.events.size())},
       {"Energy balance", format_significant(history.energy_error, 2), "largest error over the largest energy"},
       {"Real-time factor", format_significant(record.real_time_factor()), ""}});
  if (!record.swings.empty()) add_swings(record.swings, page);
  page.heading("Time histories");
  PlotSpecification deflection{"Deflection of the joints", {"time", "s"}, {"deflection", "deg"}};
  PlotSpecification torque{"Torque of the joints", {"time", "s"}, {"torque", "N m"}};
  PlotSpecification motor{"Motors", {"time", "s"}, {"angle", "deg"}};
  PlotSpecification energy{"Energy", {"time", "s"}, {"energy", "J"}};
  const auto curve = [&history](const std::string& name, int colour,
                                const std::function<double(const ArmSample&)>& value) {
    return time_curve(name, colour, history.samples, value);
  };
  for (int j = 0; j < motion.scenario.arm.motors(); ++j) {
    const std::string& name = motion.scenario.arm.joints[at(j)].name;
    deflection.curves.push_back(curve(name, j, [j](const ArmSample& s) { return s.deflection[j] / degree; }));
    torque.curves.push_back(curve(name, j, [j](const ArmSample& s) { return s.joint_torque[j]; }));
    motor.curves.push_back(curve(name, j, [j](const ArmSample& s) { return s.state.motor[j] / degree; }));
  }
  energy.curves = {curve("kinetic, potential and elastic", 0, [](const ArmSample& s) { return s.energy; }),
                   curve("lost", 1, [](const ArmSample& s) { return s.work.lost; })};
  for (const PlotSpecification* plot : {&deflection, &torque, &motor, &energy}) page.line_plot(*plot);
  page.footer(written_by(version, "history.csv and summary.json"));
  return page.html();
}

}  // namespace snare::app
