#include "python/verbs.hpp"

#include "base/files.hpp"
#include "base/inputs.hpp"
#include "base/result_folder.hpp"
#include "base/toml_tree.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/motion_tracing/trace_records.hpp"
#include "identification/records/record_file.hpp"
#include "python/convert.hpp"
#include "python/law.hpp"
#include "python/work.hpp"
#include "reduction/distil.hpp"
#include "results/curves.hpp"
#include "results/inputs.hpp"
#include "results/law_json.hpp"
#include "results/motion_comparison.hpp"
#include "results/motion_history.hpp"
#include "results/push_result.hpp"
#include "results/record_json.hpp"
#include "results/simulation.hpp"
#include "results/static_comparison.hpp"
#include "results/sweep_run.hpp"
#include "results/trace_json.hpp"
#include "scenario/scenario.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

namespace snare::python {

namespace py = pybind11;
using nlohmann::json;

namespace {

using Path = std::filesystem::path;
/// Keys and TOML values.
using Pairs = std::vector<std::pair<std::string, std::string>>;

std::vector<base::Override> overrides_of(const Pairs& pairs) {
  std::vector<base::Override> overrides;
  for (const auto& [key, value] : pairs) overrides.push_back({key, value});
  return overrides;
}

/// A document with the inputs of the call.
py::object document_of(json document) {
  return to_python(results::with_inputs(std::move(document)));
}

/// The function with inputs of its own: each is read once a call.
template <class Result, class... Arguments>
auto reading_once(Result (*function)(Arguments...)) {
  return [function](Arguments... arguments) {
    const base::InputScope scope(std::make_shared<base::Inputs>());
    return function(arguments...);
  };
}

std::shared_ptr<const identification::Experiment> experiment_of(const Path& file, const Pairs& set) {
  return std::make_shared<const identification::Experiment>(
      identification::read_experiment(file, identification::parameters(), overrides_of(set)));
}

py::tuple push(const Path& file, const Pairs& set, int threads, const py::object& progress) {
  const auto experiment = experiment_of(file, set);
  const auto pushed =
      made([experiment](const results::Watch& watch) { return results::push(*experiment, watch); }, threads,
           progress);
  ColumnSink curves;
  results::give_curves(curves, experiment->series, pushed->predictions);
  return py::make_tuple(document_of(pushed->document), curves.take());
}

/// The document and the curves of a trace; None and why for one without a base fit.
py::tuple traced(const Path& file, const Pairs& set, int threads, const py::object& progress,
                 const identification::TraceOptions& options,
                 json (*document)(const identification::Experiment&, const identification::Trace&)) {
  struct Traced {
    identification::Trace trace;
    json document;
  };
  const auto experiment = experiment_of(file, set);
  const auto result = made(
      [experiment, options, document](const results::Watch& watch) {
        identification::TraceOptions watched = options;
        watched.progress = [&watch](const std::string& stage) {
          watch.say(stage);
          return !watch.stopped();
        };
        Traced one{identification::trace(*experiment, watched), {}};
        if (one.trace.report.usable()) one.document = document(*experiment, one.trace);
        return one;
      },
      threads, progress);
  const identification::Trace& trace = result->trace;
  if (!trace.report.usable()) return py::make_tuple(py::none(), trace.report.message);
  ColumnSink curves;
  results::give_curves(curves, trace.series, trace.final_predictions, results::curve_columns(trace));
  return py::make_tuple(document_of(result->document), curves.take());
}

/// The same of records in time.
py::tuple traced_records(const Path& file, const Pairs& set, int threads, const py::object& progress,
                         bool effects) {
  struct Traced {
    identification::RecordTrace trace;
    json document;
  };
  const auto records = std::make_shared<const identification::RecordSet>(
      identification::read_records(file, overrides_of(set)));
  const auto result = made(
      [records, effects](const results::Watch& watch) {
        identification::RecordTraceOptions watched;
        watched.effects = effects;
        watched.progress = [&watch](const std::string& stage) {
          watch.say(stage);
          return !watch.stopped();
        };
        Traced one{identification::trace_records(*records, watched), {}};
        if (one.trace.report.usable()) {
          one.document = effects ? results::record_trace_json(*records, one.trace)
                                 : results::record_fit_json(*records, one.trace);
        }
        return one;
      },
      threads, progress);
  const identification::RecordTrace& trace = result->trace;
  if (!trace.report.usable()) return py::make_tuple(py::none(), trace.report.message);
  ColumnSink curves;
  results::give_record_curves(curves, *records, trace);
  return py::make_tuple(document_of(result->document), curves.take());
}

py::tuple trace(const Path& file, const Pairs& set, int threads, const py::object& progress) {
  if (identification::is_record_file(file, overrides_of(set)))
    return traced_records(file, set, threads, progress, true);
  return traced(file, set, threads, progress, {}, results::trace_document);
}

py::tuple fit(const Path& file, const Pairs& set, int threads, const py::object& progress) {
  if (identification::is_record_file(file, overrides_of(set)))
    return traced_records(file, set, threads, progress, false);
  return traced(file, set, threads, progress, results::fitting_options(), results::fit_json);
}

py::tuple distil(const Path& file, const Pairs& set, int threads, const py::object& progress) {
  const auto wire =
      std::make_shared<const reduction::WireFile>(reduction::read_wire_file(file, overrides_of(set)));
  const auto distilled = made(
      [wire](const results::Watch& watch) {
        return reduction::distil(*wire, {}, [&watch](std::size_t finished, std::size_t wanted) {
          watch.say(fmt::format("curve {} of {}", finished, wanted));
          return !watch.stopped();
        });
      },
      threads, progress);
  if (!distilled->report.usable()) return py::make_tuple(py::none(), distilled->report.message);
  const json document = results::law_json(*wire, *distilled);
  return py::make_tuple(document_of(document), laws_of(document));
}

py::tuple simulate(const Path& file, const Pairs& set, int threads, const py::object& progress) {
  const auto asked =
      std::make_shared<const scenario::Scenario>(scenario::read_scenario(file, overrides_of(set)));
  struct Simulated {
    std::vector<results::MotionRecord> records;
    json summary;
  };
  ColumnSink history, telemetry;
  const scenario::WireMotions& motions = asked->motions;
  const auto simulated = made(
      [asked](const results::Watch& watch) {
        Simulated one{results::simulate_all(asked->motions.runs, watch), {}};
        one.summary = results::simulation_document(*asked, one.records, watch);
        return one;
      },
      threads, progress);
  const std::vector<results::FinishedMotion> finished =
      results::finished_motions(motions, simulated->records);
  const results::FinishedMotion& run = finished.front();
  results::give_history(history, run.asked.motion, run.samples);
  if (!motions.sensors.empty()) results::give_telemetry(telemetry, motions, run.samples);
  return py::make_tuple(document_of(simulated->summary), history.take(), telemetry.take());
}

std::string schema_of(const Path& file) {
  const base::TomlNode root = base::parse_toml(file.string(), base::read_text(file));
  const base::TomlNode* schema = root.find("schema");
  return schema != nullptr ? schema->text : "";
}

json compared_pushes(const Path& file, const Pairs& set, int threads, const py::object& progress) {
  const auto comparison = std::make_shared<const results::StaticComparison>(
      results::read_static_comparison(file, overrides_of(set)));
  const auto compared = made(
      [comparison](const results::Watch& watch) {
        std::vector<reduction::CaseComparison> done;
        for (const reduction::StaticCase& one : comparison->cases) {
          if (watch.stopped()) break;
          watch.say("case " + one.name);
          done.push_back(reduction::compare_static(one, comparison->settings));
        }
        return done;
      },
      threads, progress);
  return results::comparison_json(*comparison, *compared);
}

json compared_motions(const Path& file, const Pairs& set, int threads, const py::object& progress) {
  const scenario::Scenario asked = scenario::read_scenario(file, overrides_of(set));
  const auto comparison = std::make_shared<const results::MotionComparison>(
      results::with_every_model(file, overrides_of(set), asked.motions));
  const auto records = made(
      [comparison](const results::Watch& watch) {
        return results::simulate_all(comparison->motions.runs, watch);
      },
      threads, progress);
  return results::comparison_json(asked, *comparison, *records);
}

py::object compare(const Path& file, const Pairs& set, int threads, const py::object& progress) {
  const bool motion = schema_of(file).starts_with("snare-scenario/");
  return document_of(motion ? compared_motions(file, set, threads, progress)
                            : compared_pushes(file, set, threads, progress));
}

/// A folder in the system's place for temporary files, removed with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_((std::filesystem::temp_directory_path() / "snare-sweep-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr)
      throw std::system_error(errno, std::generic_category(), "cannot make " + path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] Path path() const { return path_; }

 private:
  std::string path_;
};

/// The summary of a sweep, and a row a case. folder: where its journal is kept; empty: in a temporary one.
py::tuple sweep(const Path& file, const Pairs& set, int threads, const py::object& progress,
                const Path& folder) {
  const auto study = std::make_shared<const results::SweepStudy>(file, overrides_of(set));
  if (study->sweep().histories && folder.empty())
    throw base::InputError({file.string(), 0, "histories", "", "must have a folder: call sweep with out"});
  const auto temporary = folder.empty() ? std::make_shared<const TemporaryFolder>() : nullptr;
  const auto kept = std::make_shared<const base::ResultFolder>(
      temporary ? temporary->path() : folder, std::vector<std::string>{"cases.journal", "histories.h5"},
      base::ResultFolder::Asker{"out", "snare.sweep " + file.string()});
  const auto cases = std::make_shared<ColumnSink>();
  const int wanted =
      threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const auto summary = made(
      [study, temporary, kept, cases, wanted](const results::Watch& watch) {
        study::Journal journal(kept->path() / "cases.journal", study->identity(), study->count());
        std::optional<results::SweepHistories> histories;
        if (study->sweep().histories) histories.emplace(*study, kept->path());
        const results::SweepEnd end = results::run_sweep_cases(
            *study, journal, {wanted, wanted, nullptr, {}, histories ? &*histories : nullptr}, watch);
        journal.flush();
        results::give_cases(*cases, *study, end.in(journal));
        json document = results::sweep_summary(*study, results::sweep_answers(*study, journal, end));
        if (histories && !end.partial) {
          histories->join(journal, end.cases);
          document["histories"] = histories->file().string();
        }
        return document;
      },
      threads, progress);
  return py::make_tuple(document_of(*summary), cases->take());
}

}  // namespace

void add_verbs(py::module_& module) {
  const auto add = [&module](const char* name, auto function, const char* what) {
    module.def(name, reading_once(function), what, py::arg("file"), py::arg("set"), py::arg("threads"),
               py::arg("progress"));
  };
  add("push", push, "Document of `snare push` and the columns of curves.csv.");
  add("fit", fit,
      "fit.json and the columns of curves.csv; None and a message where the base model cannot be fitted.");
  add("trace", trace, "trace.json and the columns of curves.csv; None and a message as of fit.");
  add("distil", distil, "law.json and its laws; None and a message where a curve could not be computed.");
  add("simulate", simulate, "summary.json and the columns of history.csv and telemetry.csv.");
  add("compare", compare, "compare.json.");
  module.def("sweep", reading_once(sweep), "summary.json and the columns of cases.csv.", py::arg("file"),
             py::arg("set"), py::arg("threads"), py::arg("progress"), py::arg("folder"));
}

}  // namespace snare::python
