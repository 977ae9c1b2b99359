#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/report/reproduce_report.hpp"
#include "app/reproduce_json.hpp"
#include "app/result_folder.hpp"
#include "app/traced_wire.hpp"
#include "base/files.hpp"
#include "base/one_line.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/tracing/trace.hpp"
#include "results/curves.hpp"
#include "results/published_map.hpp"
#include "results/trace_findings.hpp"
#include "results/warnings.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <optional>

namespace snare::app {

using namespace results;

namespace {

using identification::Experiment;
using identification::Prediction;
using identification::Series;
using identification::Trace;
using Progress = std::function<bool(const std::string& stage)>;

constexpr const char* traced_wire_file = "traced.toml";

struct ModelWords {
  const char* name;
  const char* label;
  const char* description;
};

std::vector<std::string> assumptions(const Experiment& experiment) {
  std::vector<std::string> result;
  const bool laws = std::any_of(experiment.series.begin(), experiment.series.end(),
                                [](const Series& s) { return s.law.has_value(); });
  if (laws) {
    result.push_back(
        "The readings were not published. Their quadratic fits are compared with the same fits to the "
        "computed curves "
        "at "
        "evenly spread displacements, with one standard deviation of a reading for all positions unless the "
        "file says "
        "otherwise; R2 is taken to be rounded to its printed decimals, at least four (the key "
        "law.R2_digits).");
    std::string ranges;
    for (const Series& s : experiment.series) {
      if (s.law) ranges += fmt::format("{}{}: {:g} mm", ranges.empty() ? "" : ", ", s.name, 1e3 * s.law->to);
    }
    result.push_back("The range of displacement of the fits is not printed; assumed (" + ranges +
                     "). It changes the errors: see the key law.to_mm.");
  }
  const coupling::PushProblem& test = experiment.series.front().test;
  result.push_back(fmt::format(
      "The pusher is a cylinder of {:g} mm radius that pushes {} without friction{}.",
      1e3 * test.pusher.radius,
      test.pusher.direction == coupling::PushDirection::outward ? "with the bulge" : "against the bulge",
      test.pusher.friction > 0.0 ? fmt::format(" other than Coulomb's, mu = {:g}", test.pusher.friction)
                                 : ""));
  result.push_back(
      "The wire is computed in its plane; the displacement is counted from the first touch of pusher and "
      "wire.");
  return result;
}

identification::PredictionOptions with_shapes(const Series& series, double offset, Console& console,
                                              const std::string& label) {
  identification::PredictionOptions result;
  const std::vector<double>& d = identification::measured_displacement(series);
  // Six shapes along the push, at displacements that are computed anyhow.
  for (int i = 0; i <= 5; ++i) {
    result.shapes_at.push_back(d[(d.size() - 1) * static_cast<std::size_t>(i) / 5] - offset);
  }
  result.stop = interrupted;
  result.progress = [&console, label, &series](double travel) {
    console.progress(fmt::format("{}, {}: {:.3f} mm", label, series.name, 1e3 * travel));
    return !interrupted();
  };
  return result;
}

/// The curves of a model with these settings, with shapes.
std::vector<Prediction> curves_of(const Experiment& experiment,
                                  const std::vector<identification::Setting>& settings, Console& console,
                                  const std::string& label) {
  const identification::Model::Applied applied =
      identification::Model(experiment.series, experiment.solver, false).apply(settings);
  std::vector<Prediction> result;
  for (std::size_t k = 0; k < applied.series.size(); ++k) {
    result.push_back(identification::predict(
        applied.series[k], experiment.solver, applied.reading[k],
        with_shapes(experiment.series[k], applied.reading[k].displacement_offset, console, label)));
  }
  return result;
}

/// The experiment with its published fits taken to reach to `to` [mm], one a series, and to rest on
/// `readings` each, evenly spread.
Experiment with_ranges(Experiment experiment, const std::vector<double>& to_mm, int readings) {
  for (std::size_t k = 0; k < experiment.series.size(); ++k) {
    Series& s = experiment.series[k];
    s.law->to = 1e-3 * to_mm.at(k);
    s.test.travel.clear();
    for (int i = 0; i < readings; ++i) s.test.travel.push_back(s.law->to * i / (readings - 1));
  }
  return experiment;
}

/// On fewer edges, for fits that are only compared: 1e-4 of the force.
Experiment coarse(Experiment experiment) {
  experiment.solver.elements = std::min(experiment.solver.elements, 64);
  return experiment;
}

/// One wire with these numbers fitted to the published numbers, no effect beside them.
Trace fit_of(const Experiment& experiment, const std::vector<std::string>& free, const Progress& progress) {
  identification::TraceOptions options;
  options.free = free;
  options.most_effects = 0;
  options.attribute = false;
  options.intervals = false;
  options.progress = progress;
  return identification::trace(experiment, options);
}

/// The published fits against one wire whose numbers are fitted to them, from these settings; no replicates:
/// no bootstrap.
identification::SummaryStatistics refitted(const Experiment& experiment,
                                           const std::vector<identification::Setting>& start,
                                           std::size_t free, int replicates) {
  std::vector<std::size_t> series;
  for (std::size_t k = 0; k < experiment.series.size(); ++k) {
    if (std::ranges::find(experiment.heldout, experiment.series[k].name) == experiment.heldout.end())
      series.push_back(k);
  }
  const identification::Model model(experiment.series, experiment.solver);
  return identification::summary_statistics(
      model, series, start, free,
      {.scatter = experiment.published_scatter, .replicates = replicates, .bootstrap = replicates > 0});
}

/// The statistics as they would be with R2 rounded to four decimals and to three.
std::map<int, identification::SummaryStatistics> by_digits(const Experiment& experiment,
                                                           const Trace& fitted) {
  std::map<int, identification::SummaryStatistics> result;
  for (const int digits : {3, 4}) {
    Experiment rounded = experiment;
    for (Series& s : rounded.series) {
      if (s.law) s.law->r_squared_digits = digits;
    }
    rounded.solver.elements = std::min(rounded.solver.elements, 128);
    result[digits] = refitted(rounded, fitted.final_settings, fitted.final.numbers.size(),
                              identification::published_replicates);
  }
  return result;
}

/// How the published fits may have come about: the stored map that belongs to them, else a coarse one, which
/// takes up to a minute; null where there are no published fits, or the run was interrupted.
std::shared_ptr<const nlohmann::json> published_map_of(const Experiment& experiment, const Progress& progress,
                                                       Console& console) {
  if (!std::ranges::all_of(experiment.series, [](const Series& s) { return s.law.has_value(); }))
    return nullptr;
  const std::filesystem::path stored = data_directory() / "published" / "published_static_map.json";
  if (std::filesystem::exists(stored)) {
    auto map =
        std::make_shared<nlohmann::json>(nlohmann::json::parse(base::read_text(stored), nullptr, false));
    if (map->is_object() && map->value("inputs", "") == published_inputs(experiment)) return map;
  }
  console.end_progress();
  console.complain("no stored map of hypotheses belongs to these published fits: a coarse one is made");
  identification::MapOptions options = identification::coarse_map();
  options.progress = [&](const std::string& stage) { return progress("map of hypotheses: " + stage); };
  const identification::FitRanges ranges = identification::fit_ranges(experiment, options);
  const std::vector<identification::HypothesisMap> maps =
      identification::published_map(experiment, ranges, identification::published_hypotheses(), options);
  if (interrupted()) return nullptr;
  return std::make_shared<nlohmann::json>(published_map_json(experiment, ranges, maps, {}, true));
}

/// The leading explanation of the map, fitted again at its ranges and number of readings, with its P there.
std::optional<RefittedLeader> leading_refitted(Experiment experiment, const nlohmann::json& map) {
  const std::string leading = published_verdict(map).leading;
  const auto& entries = map.at("map");
  const auto entry =
      std::ranges::find_if(entries, [&](const nlohmann::json& e) { return e["model"] == leading; });
  const std::vector<identification::Hypothesis> all = identification::published_hypotheses();
  const auto hypothesis =
      std::ranges::find_if(all, [&](const identification::Hypothesis& h) { return h.name == leading; });
  if (entry == entries.end() || hypothesis == all.end()) return std::nullopt;
  experiment =
      with_ranges(std::move(experiment), (*entry)["to_mm"].get<std::vector<double>>(), (*entry)["readings"]);
  experiment = coarse(std::move(experiment));
  if (hypothesis->change != nullptr)
    for (Series& s : experiment.series) hypothesis->change(s.test);
  std::vector<identification::QuadraticLaw> laws;
  for (const Series& s : experiment.series) laws.push_back(*s.law);
  laws = identification::before_print(std::move(laws), *hypothesis);
  for (std::size_t k = 0; k < laws.size(); ++k) experiment.series[k].law = laws[k];
  const identification::Model model(experiment.series, experiment.solver);
  std::vector<identification::Setting> start;
  for (const auto& [key, value] : (*entry)["values"].items()) {
    const identification::Parameter& p = identification::parameters().at(key);
    start.push_back({&p, p.coordinate(model.declared(p), value.get<double>() * p.unit_size)});
  }
  for (const Series& s : experiment.series)
    start.push_back(
        {&identification::parameters().at("series[" + s.name + "].reading.displacement_offset_mm"), 0.0});
  const auto fit = refitted(experiment, start, start.size(), identification::published_replicates);
  RefittedLeader result{leading, hypothesis->meaning, (*entry)["readings"], fit.p,
                        {},      experiment,          fit.settings};
  for (const identification::Setting& s : fit.settings) result.values[s.parameter->key] = model.shown(s);
  return result;
}

/// The wire, mounts and pusher exactly as the experiment file declares them.
ReproducedModel declared_model(const Experiment& experiment, Console& console) {
  ReproducedModel model{
      .name = "declared",
      .label = "declared model",
      .description =
          "The wire, mounts and pusher exactly as the experiment file declares them; nothing fitted"};
  for (const char* key : {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N", "wire.length_mm"}) {
    const identification::Parameter& p = identification::parameters().at(key);
    model.numbers[key] = {p.shown(p.number.get(experiment.series.front().test, {}), 0.0), std::nullopt,
                          p.unit};
  }
  model.predictions = curves_of(experiment, {}, console, model.label);
  return model;
}

/// The final model of a trace.
ReproducedModel model_of(const Experiment& experiment, const Trace& trace, const ModelWords& words,
                         Console& console) {
  ReproducedModel model{.name = words.name, .label = words.label, .description = words.description};
  for (const identification::FittedNumber& n : trace.final.numbers) {
    model.numbers[n.key] = {n.value, n.standard_error, n.unit};
  }
  model.free = static_cast<int>(trace.final.numbers.size());
  model.predictions = curves_of(experiment, trace.final_settings, console, words.label);
  return model;
}

/// One row a position: the rms distance of each model from the published curve or the readings, and the
/// published scatter.
std::string error_table(const Reproduction& result) {
  std::vector<std::string> rows{fmt::format("{:<22}", "rms distance [N]")};
  for (const ReproducedModel& model : result.models) rows[0] += fmt::format("{:>14}", model.name);
  rows[0] += fmt::format("{:>20}", "published scatter");
  for (std::size_t k = 0; k < result.experiment.series.size(); ++k) {
    const Series& series = result.experiment.series[k];
    std::string row =
        fmt::format("{:<22}", fmt::format("{} ({:g} mm)", series.name, 1e3 * series.test.contact_position));
    for (const ReproducedModel& model : result.models) {
      const std::vector<double>& force = model.predictions[k].force;
      row += fmt::format("{:>14.3f}",
                         identification::misfit(identification::measured_force(series), force).rmse);
    }
    if (series.law) row += fmt::format("{:>20.3f}", series.law->scatter());
    rows.push_back(std::move(row));
  }
  return fmt::format("{}", fmt::join(rows, "\n"));
}

/// The first result: the distance of each model from the published curves, and its p.
std::string fits_in_words(const Reproduction& result) {
  std::string words = error_table(result);
  if (const auto& s = result.summary) {
    words += fmt::format(
        "\nbest_fit, over the range that the file assumes: deviance {:.3g}, {:g} degrees of freedom with {} "
        "numbers fitted, p = {:.2g}",
        s->chi2, s->dof, s->numbers, s->p);
  }
  return words;
}

void write_all_curves(const std::filesystem::path& file, const Reproduction& result) {
  const std::vector<Series>& series = result.experiment.series;
  const std::vector<Prediction>& declared = result.models.front().predictions;
  std::vector<CurveColumn> columns{{"base_N", {}}, {"final_N", {}}};
  for (std::size_t k = 0; k < series.size(); ++k) {
    columns[0].values.push_back(declared[k].force);
    columns[1].values.push_back(result.models.back().predictions[k].force);
  }
  write_curves(file, series, declared, columns);
}

/// The command with its overrides, as it would be typed.
std::string command_line(const CommonOptions& options) {
  std::string line = options.command;
  for (const std::string& change : options.overrides) line += " --set " + base::shell_word(change);
  return line;
}

/// Writes traced.toml; where nothing was traced takes away that of an earlier run, which is not this result.
void write_traced_wire(const CommonOptions& options, const Reproduction& result) {
  const std::filesystem::path file = options.out / traced_wire_file;
  const std::string text = traced_wire_toml(result, command_line(options));
  if (text.empty())
    std::filesystem::remove(file);
  else
    base::write_text(file, text);
}

void write_files(const CommonOptions& options, Reproduction& result) {
  for (const ReproducedModel& model : result.models) {
    const std::vector<std::string> more =
        push_warnings(result.experiment.series, model.predictions, model.label);
    result.warnings.insert(result.warnings.end(), more.begin(), more.end());
  }
  write_all_curves(options.out / "curves.csv", result);
  base::write_text(options.out / "report.html", reproduce_report_html(result, version()));
  write_traced_wire(options, result);
  write_result(options, "reproduce.json", reproduce_json(result));
}

std::string partial_words(const Reproduction& result) {
  std::string models;
  for (const ReproducedModel& model : result.models) models += (models.empty() ? "" : ", ") + model.label;
  return fmt::format("interrupted: what was finished is kept and marked as a part (models: {}; tracing: {})",
                     models, result.trace ? "finished" : "none");
}

/// What of a reproduction is whole, for an interruption that comes while the next part is under way.
class Finished {
 public:
  explicit Finished(const CommonOptions& options) : options_(options) {}

  void reached(const Reproduction& result) {
    {
      Reproduction copy = result;
      copy.interrupted = true;
      const std::scoped_lock lock(mutex_);
      result_ = std::move(copy);
    }
    if (!keeping_) keeping_.emplace([this] { return keep(); }, "");
  }

 private:
  /// Writes it; says what it was.
  std::string keep() {
    const std::scoped_lock lock(mutex_);
    write_files(options_, result_);
    return partial_words(result_);
  }

  const CommonOptions& options_;
  std::mutex mutex_;
  Reproduction result_;
  std::optional<KeepWhenInterrupted> keeping_;
};

/// The steps of a reproduction, each of which is kept when a later one is interrupted.
class Reproducing {
 public:
  Reproducing(Experiment experiment, const CommonOptions& options, Console& console)
      : console_(console), options_(options), finished_(options) {
    result_.experiment = std::move(experiment);
    result_.assumptions = assumptions(result_.experiment);
    result_.models.push_back(declared_model(result_.experiment, console_));
    finished_.reached(result_);
  }

  /// One wire of the declared kind, its numbers fitted to all positions together.
  void fit() {
    const ModelWords words{"best_fit", "best fit of the declared kind",
                           "The same kind of model with the listed numbers fitted to all positions together"};
    const Trace fitted = fit_of(result_.experiment, {}, progress());
    if (!fitted.report.usable()) {
      if (!interrupted()) complain(fmt::format("{}: {}", words.label, fitted.report.message));
      return;
    }
    result_.models.push_back(model_of(result_.experiment, fitted, words, console_));
    if (fitted.base_tests.published) {
      result_.summary = fitted.base_tests.published;
      result_.by_digits = by_digits(result_.experiment, fitted);
    }
    finished_.reached(result_);
  }

  /// The effect that the fitted model lacks.
  void trace() {
    identification::TraceOptions tracing;
    tracing.progress = progress();
    Trace trace = identification::trace(result_.experiment, tracing);
    if (!trace.report.usable()) return;
    const ModelWords words{"traced", "traced model",
                           "The fitted model with the effect that the tracing adds"};
    if (!trace.selected.empty())
      result_.models.push_back(model_of(result_.experiment, trace, words, console_));
    result_.trace = std::move(trace);
    finished_.reached(result_);
  }

  /// The ways in which published fits may have come about.
  void weigh() {
    result_.map = published_map_of(result_.experiment, progress(), console_);
    if (result_.map) {
      say(published_verdict(*result_.map).headline);
      result_.leader = leading_refitted(result_.experiment, *result_.map);
    }
    finished_.reached(result_);
  }

  void say_distances() { say(fits_in_words(result_)); }

  ExitStatus write() {
    console_.end_progress();
    begin_writing();
    result_.interrupted = interrupted();
    for (const ReproducedModel& model : result_.models) {
      for (std::size_t k = 0; k < result_.experiment.series.size(); ++k) {
        const numerics::SolveReport& report = model.predictions[k].curve.curve.report;
        if (!report.usable())
          complain(fmt::format("{}, series {}: {}", model.label, result_.experiment.series[k].name,
                               report.message));
      }
    }
    write_files(options_, result_);
    for (const std::string& warning : result_.warnings) console_.warn(warning);
    if (result_.interrupted) complain(partial_words(result_));
    const bool traced = std::filesystem::exists(options_.out / traced_wire_file);
    say(fmt::format("wrote {0}/curves.csv, {0}/reproduce.json, {0}/report.html{1}", options_.out.string(),
                    traced ? fmt::format(", {}/{}", options_.out.string(), traced_wire_file) : ""));
    return status_;
  }

 private:
  [[nodiscard]] Progress progress() {
    return [this](const std::string& stage) {
      console_.progress(stage);
      return !interrupted();
    };
  }
  void say(const std::string& text) {
    if (!options_.json) console_.say(text);
  }
  void complain(const std::string& text) {
    console_.complain(text);
    status_ = ExitStatus::solver_stopped;
  }

  Console& console_;
  const CommonOptions& options_;
  Finished finished_;
  Reproduction result_;
  ExitStatus status_ = ExitStatus::done;
};

}  // namespace

ExitStatus run_reproduce(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  Experiment experiment = open_experiment(
      file.empty() ? data_directory() / "experiments" / "published_static.toml" : file, options);
  for (const Series& series : experiment.series) {
    if (identification::measured_force(series).empty()) {
      throw base::InputError({experiment.file.string(), 0, "series[" + series.name + "]", "",
                              "must have readings or a law to reproduce"});
    }
  }
  const ResultFolder folder(options, {"curves.csv", "reproduce.json", "report.html", traced_wire_file});
  Reproducing steps(std::move(experiment), options, console);
  if (!interrupted()) steps.fit();
  if (!interrupted()) steps.trace();
  steps.say_distances();
  if (!interrupted()) steps.weigh();
  return steps.write();
}

}  // namespace snare::app
