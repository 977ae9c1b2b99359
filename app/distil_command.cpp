#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/report/distil_report.hpp"
#include "app/result_folder.hpp"
#include "base/csv.hpp"
#include "base/files.hpp"
#include "reduction/law_export.hpp"
#include "reduction/law_simulators.hpp"
#include "reduction/mujoco_text.hpp"
#include "results/in_mm.hpp"
#include "results/law_json.hpp"
#include "results/warnings.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>

namespace snare::app {

using namespace results;

namespace {

/// Every node of every table: places and forces, in SI-based units and in dimensionless groups.
void write_table(const std::filesystem::path& file, const reduction::Distillation& distillation) {
  base::CsvWriter csv(file, {"case", "travel_mm", "position_mm", "slack_mm", "force_N", "stiffness_N_m",
                             "unloading_N", "d_over_L", "s_over_L", "slack_over_L", "F_L2_over_EI",
                             "EA_L2_over_EI", "R_over_L", "friction"});
  for (std::size_t c = 0; c < distillation.cases.size(); ++c) {
    const reduction::DistilledCase& one = distillation.cases[c];
    const coupling::ForceTable& t = *one.table.loading;
    const double span = t.span();
    std::size_t node = 0;
    for (const double e : t.axes()[2]) {
      for (const double s : t.axes()[1]) {
        for (const double d : t.axes()[0]) {
          const double* numbers = &t.nodes()[coupling::ForceTable::numbers_a_node * node];
          base::CsvCell back;
          if (one.table.unloading)
            back =
                t.force_scale() * one.table.unloading->nodes()[coupling::ForceTable::numbers_a_node * node];
          csv.row({static_cast<long long>(c + 1), in_mm(d * span), in_mm(s * span), in_mm(e * span),
                   t.force_scale() * numbers[0], t.force_scale() / span * numbers[1], back, d, s, e,
                   numbers[0], one.groups.axial, one.groups.radius, one.groups.friction});
          ++node;
        }
      }
    }
  }
  csv.commit();
}

/// Of the case with this number, 1 the first.
void write_exports(const std::filesystem::path& out, const reduction::WireFile& file,
                   const reduction::DistilledCase& one, std::size_t number) {
  const std::string title = file.title.empty() ? file.file.filename().string() : file.title;
  std::string name = file.export_name;
  if (!name.empty() && number > 1) name += fmt::format("_{}", number);
  base::write_text(out / "law.hpp", reduction::cpp_header(one, title, name));
  base::write_text(out / "law.c", reduction::c_source(one, title, name));
  base::write_text(out / "law.h", reduction::c_header(one, title, name));
  base::write_text(out / "law.py", reduction::python_module(one, title));
  base::write_text(out / "law.mo", reduction::modelica_package(one, title, name));
  const std::vector<reduction::MujocoLaw> laws = reduction::mujoco_laws(one);
  for (const reduction::MujocoForm form : reduction::mujoco_forms) {
    if (std::ranges::any_of(laws, [form](const auto& law) { return reduction::has_form(law, form); }))
      base::write_text(out / reduction::file_of(form), reduction::mujoco_file(laws, form, title));
  }
  base::write_text(out / "law_adams.adm", reduction::adams_splines(one, title).text);
  base::write_text(out / "law_simulink.csv", reduction::lookup_table(one).csv);
}

}  // namespace

ExitStatus run_distil(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const std::vector<base::Override> overrides = overrides_of(options);
  const reduction::WireFile wire = reduction::read_wire_file(file, overrides);

  const ResultFolder folder(
      options, {"law.json", "table.csv", "report.html", "distil.journal", "law.hpp", "law.c", "law.h",
                "law.py", "law.mo", "law_mujoco.xml", "law_mujoco_linear.xml", "law_mujoco_loop.xml",
                "law_adams.adm", "law_simulink.csv"});
  const std::filesystem::path journal = options.out / "distil.journal";
  std::atomic<bool> journalled = true;
  const KeepWhenInterrupted keeping(
      [&journal, &journalled]() -> std::string {
        if (!journalled) return "what was finished is not kept: the journal could not be written";
        return fmt::format("the curves that were finished are kept in {}; the same command goes on",
                           journal.string());
      },
      std::nullopt);
  const reduction::Distillation result = reduction::distil(
      wire, journal,
      [&](std::size_t finished, std::size_t wanted) {
        console.progress(fmt::format("curve {} of {}", finished, wanted));
        return !interrupted();
      },
      [&](const std::string& what) {
        journalled = false;
        console.complain(what + "; goes on, but a run that is interrupted begins anew");
      });
  console.end_progress();
  begin_writing();
  if (!result.report.usable()) {
    console.complain(journalled
                         ? fmt::format("{}; the curves that were reached are kept in {}",
                                       result.report.message, journal.string())
                         : result.report.message + "; nothing is kept: the journal could not be written");
    if (options.json) {
      const nlohmann::json word{
          {"schema", "snare-law/1"},
          {"interrupted", result.report.termination == numerics::Termination::interrupted},
          {"stopped", result.report.message},
          {"kept", journalled ? nlohmann::json(journal.string()) : nlohmann::json()}};
      print(word.dump(1) + "\n");
    }
    return ExitStatus::solver_stopped;
  }
  const std::vector<std::string> warnings = wire_warnings(wire);
  for (const std::string& warning : warnings) console.warn(warning);
  write_table(options.out / "table.csv", result);
  for (std::size_t c = 0; c < result.cases.size(); ++c) {
    write_exports(c == 0 ? options.out : options.out / fmt::format("case_{}", c + 1), wire, result.cases[c],
                  c + 1);
  }
  base::write_text(options.out / "report.html", distil_report_html(wire, result, warnings));
  write_result(options, "law.json", law_json(wire, result));
  std::filesystem::remove(journal);
  if (options.json) return ExitStatus::done;
  for (const reduction::DistilledCase& one : result.cases) {
    const reduction::TableError& e = one.table.loading_error;
    const auto& axes = one.table.loading->axes();
    console.say(
        fmt::format("table {} x {} x {}: within {:.3g} N ({:.2g} % of {:.4g} N), {} curves of the full wire",
                    axes[0].size(), axes[1].size(), axes[2].size(), e.bound, 100.0 * e.bound / e.force_range,
                    e.force_range, one.table.curves));
    if (e.bound > wire.settings.tolerance * e.force_range) {
      console.say(fmt::format("  above the tolerance of {:g} %: the largest number of knots is reached",
                              100.0 * wire.settings.tolerance));
    }
    for (const reduction::DistilledPlace& place : one.places) {
      for (const reduction::FittedLaw& law : place.laws) {
        console.say(fmt::format("  s = {:.4g} mm  {:<26} largest error {:.3g} N of {:.4g} N",
                                1e3 * place.position, law.form->name(), law.error.largest_force,
                                law.error.force_range));
      }
    }
  }
  console.say(fmt::format("wrote {}/law.json, table.csv and the exports", options.out.string()));
  return ExitStatus::done;
}

}  // namespace snare::app
