#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/motion_json.hpp"
#include "app/report/motion_pictures.hpp"
#include "app/report/motion_report.hpp"
#include "app/motion_runs.hpp"
#include "app/report/paraview.hpp"
#include "app/report/report_page.hpp"
#include "app/simulate_kinds.hpp"
#include "scenario/contact_scenario.hpp"
#include "base/csv.hpp"
#include "base/files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <utility>

namespace snare::app {

namespace {

using scenario::ContactScenario;
using coupling::MotionResult;
using coupling::MotionSample;
using scenario::WireModel;
using Eigen::Vector3d;
using nlohmann::json;

/// One model's run.
struct ModelRun {
  const WireModel* model = nullptr;
  std::vector<MotionSample> samples;
  MotionResult result;
};

/// Angle about z [rad] of a body that turns mainly about it.
double angle(const multibody::RigidBodyState& s) {
  const Eigen::Quaterniond& q = s.orientation;
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

void write_history(const std::filesystem::path& file, const std::vector<ModelRun>& runs) {
  base::CsvWriter csv(
      file, {"model",           "time_s",         "force_N",        "penetration_mm",  "contact_arc_mm",
             "body_x_mm",       "body_y_mm",      "body_angle_deg", "body_vx_m_s",     "body_vy_m_s",
             "body_spin_rad_s", "mount_left_x_N", "mount_left_y_N", "mount_right_x_N", "mount_right_y_N",
             "kinetic_J",       "strain_J",       "potential_J",    "dissipated_J",    "impacts_J",
             "work_J",          "integrator_J",   "slip_speed_m_s",  "sticking"});
  for (const ModelRun& run : runs) {
    for (const MotionSample& s : run.samples) {
      const coupling::ContactSample& c = s.contacts.front();
      const multibody::RigidBodyState& b = s.bodies.front();
      const Vector3d left = s.mount_forces.empty() ? Vector3d::Zero() : s.mount_forces[0];
      const Vector3d right = s.mount_forces.empty() ? Vector3d::Zero() : s.mount_forces[1];
      csv.row({std::string_view(run.model->name),
               s.time,
               c.normal_force,
               -1e3 * c.gap,
               1e3 * c.arc,
               1e3 * b.position.x(),
               1e3 * b.position.y(),
               angle(b) * 180.0 / std::numbers::pi,
               b.velocity.x(),
               b.velocity.y(),
               b.spin.z(),
               left.x(),
               left.y(),
               right.x(),
               right.y(),
               s.energy.kinetic,
               s.energy.strain,
               s.energy.potential,
               s.energy.dissipated,
               s.energy.impacts,
               s.energy.work,
               s.energy.integrator,
               c.slip_speed,
               static_cast<long long>(c.sticking)});
    }
  }
  csv.commit();
}

json summary_of(const ContactScenario& scenario, const ModelRun& run) {
  const MotionResult& r = run.result;
  const multibody::RigidBodyState& before = run.samples.front().bodies.front();
  const multibody::RigidBodyState& after = run.samples.back().bodies.front();
  double first = -1.0;
  double last = -1.0;
  int touches = 0;
  json events = json::array();
  for (const coupling::MotionEvent& e : r.events) {
    using Kind = coupling::MotionEvent::Kind;
    if (e.kind == Kind::touch && touches++ == 0) first = e.time;
    if (e.kind == Kind::lift_off) last = e.time;
    events.push_back({{"time_s", e.time}, {"what", coupling::to_string(e.kind)}});
  }
  // Travel of the probe from where it would touch.
  double deepest = 0.0;
  const auto place = [&scenario](const MotionSample& s) {
    const multibody::RigidBodyState& b = s.bodies.front();
    return (b.position + b.orientation * scenario.probe).y();
  };
  const double side = scenario.push.pusher.direction == coupling::PushDirection::outward ? 1.0 : -1.0;
  const double touch = place(run.samples.front()) - side * scenario.body.start.position.y();
  for (const MotionSample& s : run.samples) deepest = std::max(deepest, side * (place(s) - touch));
  json summary{{"model", run.model->name},
               {"kind", run.model->kind},
               {"peak_force_N", r.peak_force.front()},
               {"impulse_Ns", vector_json(r.impulse.front())},
               {"first_touch_s", first >= 0.0 ? json(first) : json()},
               {"last_lift_off_s", last >= 0.0 ? json(last) : json()},
               {"touches", touches},
               {"deepest_mm", 1e3 * deepest},
               {"in_contact_at_the_end", run.samples.back().contacts.front().closed},
               {"velocity_before_m_s", vector_json(before.velocity)},
               {"velocity_after_m_s", vector_json(after.velocity)},
               {"spin_before_rad_s", vector_json(before.spin)},
               {"spin_after_rad_s", vector_json(after.spin)},
               {"events", events}};
  add_result(r, summary);
  return summary;
}

std::string report_of(const ContactScenario& scenario, const std::vector<ModelRun>& runs,
                      const json& summary) {
  ReportPage page(scenario.title, scenario.source);
  page.heading("Summary");
  add_models(summary["models"], page);
  page.heading("Time histories");
  struct Plot {
    const char* title;
    Axis y;
    std::function<double(const MotionSample&)> value;
  };
  const Plot plots[] = {
      {"Contact force",
       {"force", "N"},
       [](const MotionSample& s) { return s.contacts.front().normal_force; }},
      {"Velocity along the push",
       {"velocity y", "m/s"},
       [](const MotionSample& s) { return s.bodies.front().velocity.y(); }},
      {"Spin", {"spin z", "rad/s"}, [](const MotionSample& s) { return s.bodies.front().spin.z(); }},
      {"Place of the centre of mass",
       {"y", "mm"},
       [](const MotionSample& s) { return 1e3 * s.bodies.front().position.y(); }},
      {"Velocity along the wire",
       {"velocity x", "m/s"},
       [](const MotionSample& s) { return s.bodies.front().velocity.x(); }},
      {"Kinetic energy", {"energy", "J"}, [](const MotionSample& s) { return s.energy.kinetic; }},
  };
  for (const Plot& plot : plots) {
    PlotSpecification specification{plot.title, {"time", "s"}, plot.y};
    int colour = 0;
    for (const ModelRun& run : runs) specification.curves.push_back(time_curve(run.model->name, colour++, run.samples, plot.value));
    page.line_plot(specification);
  }
  page.heading("The contact");
  for (const ModelRun& run : runs) page.animation(animation_of(scenario, run.model->name, run.samples));
  page.footer(fmt::format(
      "Written by snare {}. The numbers are in history.csv and summary.json beside this page.", version()));
  return page.html();
}

}  // namespace

ExitStatus simulate_contact(const std::filesystem::path& file, const CommonOptions& options,
                            Console& console) {
  const ContactScenario scenario = scenario::read_contact_scenario(file, overrides_of(options));
  std::vector<MotionTask> tasks;
  for (const WireModel& model : scenario.models)
    tasks.push_back({model.name, scenario::motion_of(scenario, model), scenario::options_of(scenario, model)});
  std::vector<MotionRecord> records =
      run_motions(tasks, {options.out / "checkpoint.bin", scenario.input, scenario.output.checkpoint_wall_time}, console);
  const ExitStatus status = status_of(records);
  std::vector<ModelRun> runs;
  for (MotionRecord& record : records)
    runs.push_back({&scenario.models[runs.size()], std::move(record.samples), std::move(record.result)});
  json summary{{"schema", "snare-summary/1"}, {"kind", "contact"},
               {"title", scenario.title},     {"source", scenario.source},
               {"version", version()},        {"duration_s", scenario.options.duration},
               {"models", json::array()}};
  for (const ModelRun& run : runs) summary["models"].push_back(summary_of(scenario, run));
  write_history(options.out / "history.csv", runs);
  base::write_text(options.out / "summary.json", summary.dump(1) + "\n");
  base::write_text(options.out / "report.html", report_of(scenario, runs, summary));
  if (scenario.output.paraview) {
    for (std::size_t k = 0; k < runs.size(); ++k)
      write_paraview(options.out, runs[k].model->name, paraview_frames(tasks[k].motion, runs[k].samples));
  }
  if (options.json) {
    std::cout << summary.dump(1) << '\n';
    return status;
  }
  for (const json& m : summary["models"]) {
    console.say(fmt::format(
        "{}: peak {:.4g} N, impulse {:.4g} N s, velocity {:.4g} m/s, spin {:.4g} rad/s after; {} steps, "
        "{:.3g} times real time",
        m["model"].get<std::string>(), m["peak_force_N"].get<double>(), m["impulse_Ns"][1].get<double>(),
        m["velocity_after_m_s"][1].get<double>(), m["spin_after_rad_s"][2].get<double>(),
        m["steps"].get<long>(), m["real_time_factor"].get<double>()));
  }
  console.say(fmt::format("wrote {0}/history.csv, summary.json, report.html", options.out.string()));
  return status;
}

}  // namespace snare::app
