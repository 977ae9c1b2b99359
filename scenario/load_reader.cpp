#include "scenario/load_reader.hpp"

#include "base/csv.hpp"
#include "base/decimal.hpp"
#include "base/files.hpp"
#include "base/index.hpp"
#include "scenario/motion_reader.hpp"

#include <fmt/format.h>

#include <array>

namespace snare::scenario {

using base::Range;
using base::TomlTable;
using coupling::FrameLoad;
using Eigen::Vector3d;

namespace {

/// Corners of one line of a load over time.
void add(FrameLoad& load, double time, const Vector3d& force, const Vector3d& moment) {
  const auto n = static_cast<Eigen::Index>(load.times.size());
  load.times.push_back(time);
  load.forces.conservativeResize(3, n + 1);
  load.moments.conservativeResize(3, n + 1);
  load.forces.col(n) = force;
  load.moments.col(n) = moment;
}

/// Pulses with straight flanks.
void read_pulses(const TomlTable& table, double run, FrameLoad& load) {
  const Vector3d force = read_vector_or_zero(table, "force_N", Range::from(-1e9, 1e9), 1.0);
  const Vector3d moment = read_vector_or_zero(table, "moment_Nm", Range::from(-1e9, 1e9), 1.0);
  if (!table.has("force_N") && !table.has("moment_Nm"))
    table.fail("force_N", "must be given, or moment_Nm, or file");
  const double begin = table.number_or("begin_s", 0.0, Range::from(0.0, 1e6));
  const double duration = table.number_or("duration_s", std::max(run - begin, 1e-9), durations);
  const double ramp = table.number_or("ramp_s", 0.0, Range::from(0.0, 1e6));
  const bool lasts = !table.has("duration_s") && !table.has("shape");  // to the end: nothing leads down
  if ((lasts ? 1.0 : 2.0) * ramp > duration)
    table.fail("ramp_s", lasts ? "must end before the run" : "must be at most half of duration_s");
  const int count = table.integer_or("pulses", 1, 1, 100000);
  double every = duration;
  if (count > 1) every = table.number("every_s", durations);
  if (count > 1 && lasts) table.fail("duration_s", "must be given for several pulses");
  if (base::exceeds(duration, every, {run, begin})) table.fail("every_s", "must be at least duration_s");
  static constexpr base::Choice<bool> shapes[] = {{"flat", false}, {"half_sine", true}};
  if (table.has("shape")) load.half_sines = table.choice("shape", shapes).value_or(false);
  if (load.half_sines && table.has("ramp_s"))
    table.fail("ramp_s", "cannot stand beside shape = \"half_sine\"");
  const Vector3d none = Vector3d::Zero();
  for (int k = 0; k < count; ++k) {
    if (load.half_sines) {  // between the first two times; none up to the next pulse
      add(load, begin + k * every, force, moment);
      add(load, begin + k * every + duration, none, none);
      continue;
    }
    const double from = begin + k * every, to = from + duration;
    if (k > 0 || ramp > 0.0) add(load, from, none, none);
    add(load, from + ramp, force, moment);
    add(load, lasts ? to : to - ramp, force, moment);
    if (!lasts && (k + 1 < count || ramp > 0.0)) add(load, to, none, none);
  }
}

/// Straight between the lines of a CSV file.
void read_course(Composition& c, const TomlTable& table, FrameLoad& load) {
  for (const char* key :
       {"force_N", "moment_Nm", "begin_s", "duration_s", "ramp_s", "pulses", "every_s", "shape"}) {
    if (table.has(key)) table.fail(key, "cannot stand beside file, which says all");
  }
  const std::string name = table.text("file");
  if (name.empty()) return;
  using Presence = base::CsvColumn::Presence;
  std::vector<base::CsvColumn> columns{
      {"time_s", Presence::required, Range::from(0.0, 1e6), 1.0, base::CsvColumn::Order::non_decreasing}};
  for (const char* column : {"fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm"})
    columns.push_back({column, Presence::optional, Range::from(-1e9, 1e9)});
  try {
    const base::CsvTable csv = base::read_csv(c.folder / name, columns);
    c.input += base::read_text(c.folder / name);
    if (csv.rows < 2) table.fail("file", fmt::format("{} must have at least two lines", name));
    bool any = false;
    for (std::size_t k = 1; k < csv.columns.size(); ++k) any = any || !csv.columns[k].empty();
    if (!any)
      table.fail("file",
                 fmt::format("{} must have one of the columns fx_N, fy_N, fz_N, mx_Nm, my_Nm, mz_Nm", name));
    for (std::size_t i = 0; i < csv.rows; ++i) {
      std::array<double, 6> w{};
      for (std::size_t k = 0; k < w.size(); ++k)
        w[k] = csv.columns[k + 1].empty() ? 0.0 : csv.columns[k + 1][i];
      add(load, csv.columns[0][i], {w[0], w[1], w[2]}, {w[3], w[4], w[5]});
    }
  } catch (const base::InputError& error) {
    for (const base::InputProblem& problem : error.problems()) c.document.add(problem);
  }
}

}  // namespace

void read_loads(Composition& c) {
  Names names("load");
  const double run = c.document.root().number_or("duration_s", 1.0, durations);
  for (const TomlTable& table : c.document.root().tables("loads")) {
    FrameLoad load;
    load.name = names.take(table);
    static_cast<void>(table.text("frame"));
    const PlacedFrame on = c.placement.frame(table, "frame").value_or(PlacedFrame{});
    load.carrier = on.carrier;
    load.X_WF = on.X_WF * read_pose_in_frame(table);
    static constexpr base::Choice<bool> axes[] = {{"frame", true}, {"world", false}};
    if (table.has("axes")) load.in_frame = table.choice("axes", axes).value_or(true);
    if (table.has("file"))
      read_course(c, table, load);
    else
      read_pulses(table, run, load);
    c.motion.loads.push_back(load);
  }
}

}  // namespace snare::scenario
