#include "base/units.hpp"
#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/motion_json.hpp"
#include "app/report/motion_pictures.hpp"
#include "app/report/motion_report.hpp"
#include "app/motion_runs.hpp"
#include "app/report/paraview.hpp"
#include "app/report/report_page.hpp"
#include "app/simulate_kinds.hpp"
#include "scenario/arm_contact_scenario.hpp"
#include "base/csv.hpp"
#include "base/files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <iostream>
#include <numbers>

namespace snare::app {

namespace {

using scenario::ArmContactScenario;
using coupling::MotionResult;
using coupling::MotionSample;
using Eigen::Vector3d;
using nlohmann::json;

using base::degree;

struct ModelRun {
  std::string name;
  coupling::Motion motion;
  std::vector<MotionSample> samples;
  MotionResult result;
};

/// Force of the arm on what it carries, world axes [N].
Vector3d carried_force(const ModelRun& run, const MotionSample& s) {
  if (!s.welds.empty()) return s.welds.front().force;
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < run.motion.mounts.size(); ++k) sum += s.mount_forces[k];
  return sum;
}

double deflection(const ModelRun& run, const MotionSample& s, int joint) {
  return multibody::deflection(run.motion.arms.front().arm, s.arms.front().state, joint);
}

void write_history(const std::filesystem::path& file, const std::vector<ModelRun>& runs) {
  std::vector<std::string> columns{"model", "time_s", "force_N", "penetration_mm", "contact_arc_mm"};
  for (const char* what : {"body_x_mm", "body_y_mm", "body_z_mm", "body_vx_m_s", "body_vy_m_s", "body_vz_m_s",
                           "body_spin_x_rad_s", "body_spin_y_rad_s", "body_spin_z_rad_s", "carried_x_N",
                           "carried_y_N", "carried_z_N"})
    columns.emplace_back(what);
  const multibody::ElasticArm& arm = runs.front().motion.arms.front().arm;
  for (const multibody::ElasticJoint& j : arm.joints) {
    for (const char* what : {"motor_deg", "deflection_deg", "torque_Nm"})
      columns.push_back(j.name + "_" + what);
  }
  for (const char* what :
       {"kinetic_J", "strain_J", "potential_J", "dissipated_J", "impacts_J", "work_J", "integrator_J"})
    columns.emplace_back(what);
  base::CsvWriter csv(file, columns);
  for (const ModelRun& run : runs) {
    for (const MotionSample& s : run.samples) {
      const coupling::ContactSample& c = s.contacts.front();
      const multibody::RigidBodyState& b = s.bodies.front();
      const Vector3d carried = carried_force(run, s);
      std::vector<base::CsvCell> row{std::string_view(run.name), s.time, c.normal_force, -1e3 * c.gap,
                                         1e3 * c.arc};
      for (const double x : {b.position.x(), b.position.y(), b.position.z()}) row.emplace_back(1e3 * x);
      for (const Vector3d* v : {&b.velocity, &b.spin, &carried}) {
        for (int k = 0; k < 3; ++k) row.emplace_back((*v)[k]);
      }
      const MotionSample::Arm& a = s.arms.front();
      for (int j = 0; j < arm.motors(); ++j) {
        for (const double x : {a.state.motor[j] / degree, deflection(run, s, j) / degree, a.joint_torque[j]})
          row.emplace_back(x);
      }
      const coupling::EnergyBalance& e = s.energy;
      for (const double x : {e.kinetic, e.strain, e.potential, e.dissipated, e.impacts, e.work, e.integrator})
        row.emplace_back(x);
      csv.row(row);
    }
  }
  csv.commit();
}

json summary_of(const ModelRun& run) {
  const MotionResult& r = run.result;
  const MotionSample& first = run.samples.front();
  const MotionSample& last = run.samples.back();
  json events = json::array();
  int touches = 0;
  for (const coupling::MotionEvent& e : r.events) {
    touches += e.kind == coupling::MotionEvent::Kind::touch ? 1 : 0;
    events.push_back({{"time_s", e.time}, {"what", coupling::to_string(e.kind)}});
  }
  json deflections = json::object();
  for (int j = 0; j < run.motion.arms.front().arm.motors(); ++j) {
    double largest = 0.0;
    for (const MotionSample& s : run.samples) largest = std::max(largest, std::abs(deflection(run, s, j)));
    deflections[run.motion.arms.front().arm.joints[static_cast<std::size_t>(j)].name] = largest / degree;
  }
  json summary{{"model", run.name},
               {"peak_force_N", r.peak_force.front()},
               {"impulse_Ns", vector_json(r.impulse.front())},
               {"touches", touches},
               {"in_contact_at_the_end", last.contacts.front().closed},
               {"velocity_before_m_s", vector_json(first.bodies.front().velocity)},
               {"velocity_after_m_s", vector_json(last.bodies.front().velocity)},
               {"spin_before_rad_s", vector_json(first.bodies.front().spin)},
               {"spin_after_rad_s", vector_json(last.bodies.front().spin)},
               {"largest_deflection_deg", deflections},
               {"events", events}};
  add_result(r, summary);
  return summary;
}

std::string report_of(const ArmContactScenario& scenario, const std::vector<ModelRun>& runs,
                      const json& summary) {
  ReportPage page(scenario.title, scenario.source);
  page.heading("Summary");
  add_models(summary["models"], page);
  page.heading("Time histories");
  PlotSpecification force{"Contact force", {"time", "s"}, {"force", "N"}};
  PlotSpecification velocity{"Body's velocity along the push", {"time", "s"}, {"velocity y", "m/s"}};
  int colour = 0;
  for (const ModelRun& run : runs) {
    force.curves.push_back(time_curve(run.name, colour, run.samples, [](const MotionSample& s) { return s.contacts.front().normal_force; }));
    velocity.curves.push_back(time_curve(run.name, colour++, run.samples, [](const MotionSample& s) { return s.bodies.front().velocity.y(); }));
  }
  page.line_plot(force);
  page.line_plot(velocity);
  for (const ModelRun& run : runs) {
    PlotSpecification joints{"Deflection of the joints: " + run.name, {"time", "s"}, {"deflection", "deg"}};
    PlotSpecification motors{"Motors: " + run.name, {"time", "s"}, {"angle from the start", "deg"}};
    const multibody::ElasticArm& arm = run.motion.arms.front().arm;
    for (int j = 0; j < arm.motors(); ++j) {
      const std::string& name = arm.joints[static_cast<std::size_t>(j)].name;
      joints.curves.push_back(time_curve(name, j, run.samples, [&run, j](const MotionSample& s) { return deflection(run, s, j) / degree; }));
      const double start = run.samples.front().arms.front().state.motor[j];
      motors.curves.push_back(time_curve(name, j, run.samples, [j, start](const MotionSample& s) {
        return (s.arms.front().state.motor[j] - start) / degree;
      }));
    }
    page.line_plot(joints);
    page.line_plot(motors);
  }
  page.heading("The contact");
  for (const ModelRun& run : runs) {
    page.animation(animation_of(scenario.contact, run.name, run.samples));
    for (const View view : {View::along_z, View::along_x}) page.animation(animation_of(run.motion, run.samples, view));
  }
  page.footer(fmt::format(
      "Written by snare {}. The numbers are in history.csv and summary.json beside this page.", version()));
  return page.html();
}

}  // namespace

ExitStatus simulate_arm_contact(const std::filesystem::path& file, const CommonOptions& options,
                                Console& console) {
  const ArmContactScenario scenario = scenario::read_arm_contact_scenario(file, overrides_of(options));
  std::vector<MotionTask> tasks;
  for (const scenario::WireModel& model : scenario.contact.models)
    tasks.push_back({model.name, scenario::motion_of(scenario, model), scenario::options_of(scenario.contact, model)});
  std::vector<MotionRecord> records = run_motions(
      tasks, {options.out / "checkpoint.bin", scenario.input, scenario.contact.output.checkpoint_wall_time}, console);
  const ExitStatus status = status_of(records);
  std::vector<ModelRun> runs;
  for (MotionRecord& record : records) {
    MotionTask& task = tasks[runs.size()];
    runs.push_back({task.name, std::move(task.motion), std::move(record.samples), std::move(record.result)});
  }
  json summary{{"schema", "snare-summary/1"}, {"kind", "arm_contact"},
               {"title", scenario.title},     {"source", scenario.source},
               {"version", version()},        {"duration_s", scenario.contact.options.duration},
               {"models", json::array()}};
  for (const ModelRun& run : runs) summary["models"].push_back(summary_of(run));
  write_history(options.out / "history.csv", runs);
  base::write_text(options.out / "summary.json", summary.dump(1) + "\n");
  base::write_text(options.out / "report.html", report_of(scenario, runs, summary));
  if (scenario.contact.output.paraview) {
    for (const ModelRun& run : runs) write_paraview(options.out, run.name, paraview_frames(run.motion, run.samples));
  }
  if (options.json) {
    std::cout << summary.dump(1) << '\n';
    return status;
  }
  for (const json& m : summary["models"]) {
    console.say(fmt::format(
        "{}: peak {:.4g} N, impulse {:.4g} N s, velocity {:.4g} m/s after; {} steps, {:.3g} times real time",
        m["model"].get<std::string>(), m["peak_force_N"].get<double>(), m["impulse_Ns"][1].get<double>(),
        m["velocity_after_m_s"][1].get<double>(), m["steps"].get<long>(),
        m["real_time_factor"].get<double>()));
  }
  console.say(fmt::format("wrote {0}/history.csv, summary.json, report.html", options.out.string()));
  return status;
}

}  // namespace snare::app
