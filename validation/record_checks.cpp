#include "validation/record_checks.hpp"

#include "identification/motion_tracing/trace_records.hpp"
#include "identification/records/record_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace snare::validation {

namespace {

using identification::MotionTrace;

double relative_error(const identification::MotionStage& stage) {
  return stage.errors.empty() ? not_computed : stage.errors.front().relative;
}

Row yes(const std::string& group, const std::string& name, const std::string& source, bool value) {
  return {group, name, "", source, 1.0, value ? 1.0 : 0.0, ErrorKind::absolute, 0.5};
}

bool names(const MotionTrace& trace, const std::string& effect) {
  const auto is = [&](const std::string& label) { return label.starts_with(effect + " ("); };
  return std::any_of(trace.selected.begin(), trace.selected.end(), is) ||
         std::any_of(trace.partial.begin(), trace.partial.end(), is);
}

/// A shipped file with its readings where they are.
identification::RecordSet read(const std::filesystem::path& file, const std::filesystem::path& csv, int records,
                               bool course_too) {
  const std::string path = fmt::format("\"{}\"", std::filesystem::absolute(csv).string());
  std::vector<base::Override> overrides;
  for (int k = 1; k <= records; ++k) overrides.push_back({fmt::format("records[{}].file", k), path});
  if (course_too) overrides.push_back({"scenario.drives[1].course_file", path});
  return identification::read_records(file, overrides);
}

std::vector<Row> drive_rows(const std::filesystem::path& file, const std::filesystem::path& csv) {
  const std::string group = "tracing of a measured drive";
  const std::string source = "Janot, Gautier, Brunot 2019 (EMPS): inverse model, the same low-pass filter";
  const identification::RecordSet set = read(file, csv, 2, true);
  const MotionTrace t = identification::trace_records(set);
  const double before = t.base.heldout.empty() ? not_computed : t.base.heldout.front().rmse;
  const double after = t.final.heldout.empty() ? not_computed : t.final.heldout.front().rmse;
  // The authors' filter is Chebyshev's and theirs at the same 40 Hz; with ours their own regression changes by 0.05 % of the force.
  return {{group,
           "force of inertia and viscous friction, of the readings (published with an offset, which takes 1 % of it)",
           "", source, 0.17, relative_error(t.base), ErrorKind::absolute, 0.015},
          {group, "force with what was found, of the readings: at most as published with asymmetric friction", "",
           source, 0.0, relative_error(t.final), ErrorKind::absolute, 0.0311},
          yes(group, "dry friction is named first", source,
              !t.selected.empty() && t.selected.front().starts_with("joint_coulomb_friction (")),
          yes(group, "asymmetry of the friction is named, and nothing else", source,
              t.selected.size() == 2 && (names(t, "joint_viscous_asymmetry") || names(t, "joint_friction_asymmetry"))),
          yes(group, "partly explained: what is left is said", source,
              t.kind == identification::VerdictKind::partly_explained),
          {group, "position under its own control after over before, simulated: at most a half", "", source, 0.0,
           after / before, ErrorKind::absolute, 0.5}};
}

std::vector<Row> pendulum_rows(const std::filesystem::path& file, const std::filesystem::path& csv) {
  const std::string group = "tracing of a measured pendulum";
  const std::string source = "MultiArm-Pendulum, single pendulum: viscous bearing as its authors fit it";
  const identification::RecordSet set = read(file, csv, 6, false);
  const MotionTrace t = identification::trace_records(set);
  const double declared = t.declared.heldout_rmse,
               last = t.with_partial ? t.with_partial->heldout_rmse : t.final.heldout_rmse;
  return {
      yes(group, "a constant loss is named, or helps without explaining", source, names(t, "joint_coulomb_friction")),
      yes(group, "a quadratic loss is named, or helps without explaining", source, names(t, "joint_quadratic_drag")),
      {group, "error of the parts held out over that of the authors' model: below one", "", source, 0.0,
       last / declared, ErrorKind::absolute, 1.0}};
}

}  // namespace

std::vector<Check> record_checks(const std::filesystem::path& shipped, const std::filesystem::path& measured) {
  struct One {
    const char *name, *file, *csv;
    std::vector<Row> (*rows)(const std::filesystem::path&, const std::filesystem::path&);
  };
  std::vector<Check> checks;
  for (const One& one :
       {One{"tracing of a measured drive", "emps.toml", "emps/emps.csv", drive_rows},
        One{"tracing of a measured pendulum", "pendulum.toml", "pendulum/free_swing.csv", pendulum_rows}}) {
    const std::filesystem::path file = shipped / "records" / one.file, csv = measured / one.csv;
    const bool there = std::filesystem::is_regular_file(csv);
    checks.push_back({one.name, [rows = one.rows, file, csv] { return rows(file, csv); },
                      there ? "" : fmt::format("the measured file {} is not in {}", one.csv, measured.string())});
  }
  return checks;
}

}  // namespace snare::validation
