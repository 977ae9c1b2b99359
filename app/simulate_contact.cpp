#include "app/commands.hpp"
#include "app/contact_checkpoint.hpp"
#include "app/experiment_input.hpp"
#include "app/paraview.hpp"
#include "app/report_page.hpp"
#include "app/simulate_kinds.hpp"
#include "coupling/contact_scenario.hpp"
#include "numerics/csv.hpp"
#include "numerics/files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <numbers>
#include <optional>
#include <utility>

namespace snare::app {

namespace {

using coupling::ContactScenario;
using coupling::MotionResult;
using coupling::MotionSample;
using coupling::WireModel;
using Eigen::Vector3d;
using nlohmann::json;

/// One model's run.
struct ModelRun {
  const WireModel* model = nullptr;
  std::vector<MotionSample> samples;
  MotionResult result;
  double side = 1.0;  // of the push along y
};

/// Angle about z [rad] of a body that turns mainly about it.
double angle(const multibody::RigidBodyState& s) {
  const Eigen::Quaterniond& q = s.orientation;
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

/// Runs a scenario's models in turn, with checkpoints between which nothing is lost.
class ScenarioRun {
 public:
  ScenarioRun(const ContactScenario& scenario, const std::filesystem::path& out, Console& console)
      : scenario_(scenario), file_(out / "checkpoint.bin"), console_(console), written_(Clock::now()) {
    LoadedCheckpoint loaded = read_contact_checkpoint(file_, scenario.input);
    if (!loaded.refusal.empty()) console.complain(loaded.refusal);
    if (!loaded.progress || loaded.progress->finished.size() >= scenario.models.size()) return;
    progress_ = std::move(*loaded.progress);
    console.say(fmt::format("goes on from {}: {} at {:.6g} s", file_.string(),
                            scenario.models[progress_.finished.size()].name,
                            progress_.state ? progress_.state->time : 0.0));
  }

  /// Stops early when it is interrupted; then the checkpoint is kept for the next time.
  [[nodiscard]] std::vector<ModelRun> all() {
    bool stopped = false;
    while (!stopped && progress_.finished.size() < scenario_.models.size()) {
      stopped = !run_next();
    }
    if (!stopped) {
      std::error_code ignored;
      std::filesystem::remove(file_, ignored);
    }
    std::vector<ModelRun> runs;
    for (ContactProgress::Model& model : progress_.finished) {
      ModelRun run;
      run.model = &scenario_.models[runs.size()];
      run.side = scenario_.push.pusher.direction == coupling::PushDirection::outward ? 1.0 : -1.0;
      run.samples = std::move(model.samples);
      run.result = std::move(model.result);
      runs.push_back(std::move(run));
    }
    return runs;
  }

 private:
  using Clock = std::chrono::steady_clock;

  static double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }

  /// False when it was interrupted.
  bool run_next() {
    const WireModel& model = scenario_.models[progress_.finished.size()];
    const double duration = scenario_.options.duration;
    const std::optional<coupling::MotionState> from = progress_.state;
    const double begun = from ? from->time : 0.0;
    std::vector<MotionSample> samples = progress_.samples;
    const auto begin = Clock::now();
    coupling::MotionOptions options = coupling::options_of(scenario_, model);
    options.stop = interrupted;
    MotionResult result = coupling::simulate(
        coupling::motion_of(scenario_, model), options,
        [&](const MotionSample& s) {
          samples.push_back(s);
          const double share = (s.time - begun) / (duration - begun);
          console_.progress(fmt::format("{}: {:.3f} of {:.3f} s, {:.0f} s to go", model.name, s.time, duration,
                                        share > 0.0 ? seconds_since(begin) * (1.0 - share) / share : 0.0));
          return false;
        },
        from ? &*from : nullptr,
        [&](const coupling::MotionState& state) {
          progress_.state = state;
          progress_.samples.insert(progress_.samples.end(), samples.begin() + static_cast<std::ptrdiff_t>(progress_.samples.size()),
                                   samples.end());
          if (seconds_since(written_) >= scenario_.checkpoint_wall_time) write();
        });
    console_.end_progress();
    const bool stopped = result.report.termination == numerics::Termination::interrupted;
    if (stopped) write();  // before the model counts as finished: it goes on from its last checkpoint
    progress_.finished.push_back({std::move(samples), std::move(result)});
    if (stopped) return false;
    progress_.samples.clear();
    progress_.state.reset();
    if (seconds_since(written_) >= scenario_.checkpoint_wall_time) write();
    return true;
  }

  void write() {
    write_contact_checkpoint(file_, scenario_.input, progress_);
    written_ = Clock::now();
  }

  const ContactScenario& scenario_;
  std::filesystem::path file_;
  Console& console_;
  ContactProgress progress_;
  Clock::time_point written_;  // when a checkpoint was
};

void write_history(const std::filesystem::path& file, const std::vector<ModelRun>& runs) {
  numerics::CsvWriter csv(
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

json vector_json(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
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
  const double touch = place(run.samples.front()) - run.side * scenario.body.start.position.y();
  for (const MotionSample& s : run.samples) deepest = std::max(deepest, run.side * (place(s) - touch));
  const numerics::IdaStatistics& n = r.statistics;
  return {{"model", run.model->name},
          {"kind", run.model->kind},
          {"finished", r.report.usable()},
          {"message", r.report.usable() ? json() : json(r.report.message)},
          {"time_s", r.report.time},
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
          {"energy_J",
           {{"kinetic", r.energy.kinetic},
            {"strain", r.energy.strain},
            {"potential", r.energy.potential},
            {"dissipated", r.energy.dissipated},
            {"impacts", r.energy.impacts},
            {"work", r.energy.work},
            {"integrator", r.energy.integrator}}},
          {"momentum_error_Ns", vector_json(r.momentum_error)},
          {"angular_momentum_error_Nms", vector_json(r.angular_momentum_error)},
          {"largest_penetration_m", r.largest_penetration},
          {"largest_gap_m", r.largest_gap},
          {"largest_drift", r.largest_drift},
          {"steps", n.steps},
          {"residuals", n.residuals},
          {"jacobians", n.jacobians},
          {"factorizations", n.factorizations},
          {"analyses", n.analyses},
          {"restarts", n.restarts},
          {"wall_s", r.wall_seconds},
          {"real_time_factor", r.wall_seconds > 0.0 ? r.report.time / r.wall_seconds : 0.0},
          {"events", events}};
}

Curve curve_of(const ModelRun& run, int colour, const std::function<double(const MotionSample&)>& value) {
  Curve curve{run.model->name, {}, {}, CurveStyle::line, colour};
  for (const MotionSample& s : run.samples) {
    curve.x.push_back(s.time);
    curve.y.push_back(value(s));
  }
  return curve;
}

AnimationSpecification animation_of(const ContactScenario& scenario, const ModelRun& run) {
  AnimationSpecification animation{
      "Wire and probe: " + run.model->name,
      {"wire", "probe", "arm to the centre of mass"},
      {},
      "To scale; the probe is the circle, the line from it leads to the body's centre of mass."};
  constexpr std::size_t most_frames = 200;
  constexpr int corners = 36;
  const std::size_t step = std::max<std::size_t>(1, run.samples.size() / most_frames);
  const double radius = scenario.push.pusher.radius;
  for (std::size_t k = 0; k < run.samples.size(); k += step) {
    const MotionSample& s = run.samples[k];
    AnimationFrame frame{fmt::format("t = {:.3f} s, {:.3g} N", s.time, s.contacts.front().normal_force),
                         {{}, {}, {}}};
    for (const Eigen::Matrix3Xd& w : s.wires) {
      for (Eigen::Index i = 0; i < w.cols(); ++i)
        frame.outlines[0].insert(frame.outlines[0].end(), {1e3 * w(0, i), 1e3 * w(1, i)});
    }
    const multibody::RigidBodyState& b = s.bodies.front();
    const Vector3d probe = b.position + b.orientation * scenario.probe;
    for (int i = 0; i <= corners; ++i) {
      const double a = 2.0 * std::numbers::pi * i / corners;
      frame.outlines[1].insert(frame.outlines[1].end(), {1e3 * (probe.x() + radius * std::cos(a)),
                                                         1e3 * (probe.y() + radius * std::sin(a))});
    }
    frame.outlines[2] = {1e3 * probe.x(), 1e3 * probe.y(), 1e3 * b.position.x(), 1e3 * b.position.y()};
    animation.frames.push_back(std::move(frame));
  }
  return animation;
}

std::string report_of(const ContactScenario& scenario, const std::vector<ModelRun>& runs,
                      const json& summary) {
  ReportPage page(scenario.title, scenario.source);
  page.heading("Summary");
  Table table{"",
              {{"Model", ColumnKind::code},
               {"Peak force [N]", ColumnKind::number},
               {"Impulse [N s]", ColumnKind::number},
               {"Velocity after [m/s]", ColumnKind::number},
               {"Spin after [rad/s]", ColumnKind::number},
               {"Touches", ColumnKind::number},
               {"Integrator's energy [J]", ColumnKind::number},
               {"Steps", ColumnKind::number},
               {"Real-time factor", ColumnKind::number}},
              {}};
  for (const json& m : summary["models"]) {
    table.rows.push_back(
        {m["model"].get<std::string>(), format_significant(m["peak_force_N"].get<double>()),
         format_significant(m["impulse_Ns"][1].get<double>()),
         format_significant(m["velocity_after_m_s"][1].get<double>()),
         format_significant(m["spin_after_rad_s"][2].get<double>()), std::to_string(m["touches"].get<int>()),
         format_significant(m["energy_J"]["integrator"].get<double>(), 2),
         std::to_string(m["steps"].get<long>()), format_significant(m["real_time_factor"].get<double>())});
    if (!m["finished"].get<bool>())
      page.callout(m["model"].get<std::string>() + ": " + m["message"].get<std::string>(), Tone::bad);
  }
  page.table(table);
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
    for (const ModelRun& run : runs) specification.curves.push_back(curve_of(run, colour++, plot.value));
    page.line_plot(specification);
  }
  page.heading("The contact");
  for (const ModelRun& run : runs) page.animation(animation_of(scenario, run));
  page.footer(fmt::format(
      "Written by snare {}. The numbers are in history.csv and summary.json beside this page.", version()));
  return page.html();
}

void write_shapes(const std::filesystem::path& out, const ModelRun& run) {
  std::vector<ParaviewFrame> frames;
  for (const MotionSample& s : run.samples) frames.push_back({s.time, s.wires});
  write_paraview(out, run.model->name, frames);
}

}  // namespace

ExitStatus simulate_contact(const std::filesystem::path& file, const CommonOptions& options,
                            Console& console) {
  const ContactScenario scenario = coupling::read_contact_scenario(file, overrides_of(options));
  const std::vector<ModelRun> runs = ScenarioRun(scenario, options.out, console).all();
  ExitStatus status = ExitStatus::done;
  for (const ModelRun& run : runs) {
    const numerics::IdaReport& report = run.result.report;
    if (report.usable()) continue;
    const bool stopped = report.termination == numerics::Termination::interrupted;
    console.complain(fmt::format("{}: {} (what was reached is kept{})", run.model->name, report.message,
                                 stopped ? "; the same command goes on from the last checkpoint" : ""));
    status = ExitStatus::solver_stopped;
  }
  json summary{{"schema", "snare-summary/1"}, {"kind", "contact"},
               {"title", scenario.title},     {"source", scenario.source},
               {"version", version()},        {"duration_s", scenario.options.duration},
               {"models", json::array()}};
  for (const ModelRun& run : runs) summary["models"].push_back(summary_of(scenario, run));
  write_history(options.out / "history.csv", runs);
  numerics::write_text(options.out / "summary.json", summary.dump(1) + "\n");
  numerics::write_text(options.out / "report.html", report_of(scenario, runs, summary));
  if (scenario.paraview) {
    for (const ModelRun& run : runs) write_shapes(options.out, run);
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
