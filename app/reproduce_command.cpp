#include "app/commands.hpp"
#include "app/curves_csv.hpp"
#include "app/experiment_input.hpp"
#include "app/report/reproduce_report.hpp"
#include "app/trace_json.hpp"
#include "identification/tracing/trace.hpp"
#include "base/files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>

namespace snare::app {

namespace {

using identification::Experiment;
using identification::Prediction;
using identification::Series;
using nlohmann::json;

/// A model of the wire beside the published curves.
struct ModelCurves {
  std::string name;
  std::string label;
  std::string description;
  json parameters;
  int free = 0;
  std::vector<Prediction> predictions;
  std::vector<double> radius_mm;  // of the pusher, one a series
};

std::vector<double> in_mm(const std::vector<double>& values) {
  std::vector<double> result(values);
  for (double& v : result) v *= 1e3;
  return result;
}

/// dF/dd [N/mm] of a curve by central differences (one-sided at its ends).
std::vector<double> tangent_stiffness(const std::vector<double>& displacement, const std::vector<double>& force) {
  const std::size_t n = std::min(displacement.size(), force.size());
  std::vector<double> result;
  for (std::size_t i = 0; i < n && n > 1; ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1;
    const std::size_t b = std::min(i + 1, n - 1);
    result.push_back(1e-3 * (force[b] - force[a]) / (displacement[b] - displacement[a]));
  }
  return result;
}

json shape_json(const coupling::PushShape& shape, double offset, double radius_mm) {
  return {{"displacement_mm", 1e3 * (shape.travel + offset)},
          {"x_mm", in_mm(shape.x)},
          {"y_mm", in_mm(shape.y)},
          {"arc_mm", in_mm(shape.arc)},
          {"tension_N", shape.tension},
          {"moment_Nm", shape.moment},
          {"pusher_x_mm", 1e3 * shape.pusher_centre.x()},
          {"pusher_y_mm", 1e3 * shape.pusher_centre.y()},
          {"pusher_radius_mm", radius_mm}};
}

json series_model_json(const Series& series, const Prediction& prediction, double radius_mm) {
  const std::vector<double>& displacement = identification::measured_displacement(series);
  const identification::Misfit misfit = identification::misfit(identification::measured_force(series), prediction.force);
  json shapes = json::array();
  for (const coupling::PushShape& shape : prediction.curve.curve.shapes) {
    shapes.push_back(shape_json(shape, prediction.reading.displacement_offset, radius_mm));
  }
  double largest = 0.0;
  for (const double f : prediction.force) largest = std::max(largest, f);
  json result{{"force_N", prediction.force},
              {"stiffness_N_mm", tangent_stiffness(displacement, prediction.force)},
              {"rmse_N", misfit.rmse},
              {"nrmse", misfit.nrmse},
              {"max_N", largest},
              {"shapes", shapes}};
  if (!prediction.curve.curve.report.usable()) result["stopped"] = prediction.curve.curve.report.message;
  return result;
}

json series_json(const Series& series, const std::vector<ModelCurves>& models, std::size_t index) {
  const std::vector<double>& displacement = identification::measured_displacement(series);
  json result{{"name", series.name},
              {"contact_position_mm", 1e3 * series.test.contact_position},
              {"range_mm", 1e3 * *std::max_element(displacement.begin(), displacement.end())},
              {"displacement_mm", in_mm(displacement)},
              {"published_N", identification::measured_force(series)}};
  if (series.law) {
    const identification::QuadraticLaw& law = *series.law;
    result["published"] = {{"A_N_m2", law.a}, {"B_N_m", law.b}, {"C_N", law.c}, {"R2", law.r_squared},
                           {"sigma_N", law.scatter()}};
    std::vector<double> stiffness;
    for (const double d : displacement) stiffness.push_back(1e-3 * (2.0 * law.a * d + law.b));
    result["published_stiffness_N_mm"] = stiffness;
  } else {
    result["published_stiffness_N_mm"] =
        tangent_stiffness(displacement, identification::measured_force(series));
    if (series.force_sigma) result["published"] = {{"sigma_N", *series.force_sigma}};
  }
  for (const ModelCurves& model : models) {
    result["models"][model.name] = series_model_json(series, model.predictions[index], model.radius_mm[index]);
  }
  return result;
}

json model_json(const Experiment& experiment, const ModelCurves& model) {
  std::vector<double> measured;
  std::vector<double> predicted;
  for (std::size_t k = 0; k < experiment.series.size(); ++k) {
    const std::vector<double> force = identification::measured_force(experiment.series[k]);
    const std::vector<double>& computed = model.predictions[k].force;
    const std::size_t n = std::min(force.size(), computed.size());
    measured.insert(measured.end(), force.begin(), force.begin() + static_cast<std::ptrdiff_t>(n));
    predicted.insert(predicted.end(), computed.begin(), computed.begin() + static_cast<std::ptrdiff_t>(n));
  }
  const identification::Misfit misfit = identification::misfit(measured, predicted);
  return {{"name", model.name},     {"label", model.label},   {"description", model.description},
          {"parameters", model.parameters}, {"rmse_N", misfit.rmse}, {"nrmse", misfit.nrmse}, {"free", model.free}};
}

std::vector<std::string> assumptions(const Experiment& experiment) {
  std::vector<std::string> result;
  const bool laws = std::any_of(experiment.series.begin(), experiment.series.end(),
                                [](const Series& s) { return s.law.has_value(); });
  if (laws) {
    result.push_back(
        "The readings were not published: the quadratic fits stand for them, at evenly spread displacements. "
        "Their scatter follows from the printed R2 if the readings were spread evenly too.");
    std::string ranges;
    for (const Series& s : experiment.series) {
      if (s.law) ranges += fmt::format("{}{}: {:g} mm", ranges.empty() ? "" : ", ", s.name, 1e3 * s.law->to);
    }
    result.push_back("The range of displacement of the fits is not printed; assumed (" + ranges +
                     "). It changes the errors: see the key law.to_mm.");
  }
  const coupling::PushProblem& test = experiment.series.front().test;
  result.push_back(fmt::format("The pusher is a cylinder of {:g} mm radius that pushes {} without friction{}.",
                               1e3 * test.pusher.radius,
                               test.pusher.direction == coupling::PushDirection::outward ? "with the bulge"
                                                                                       : "against the bulge",
                               test.pusher.friction > 0.0 ? fmt::format(" other than Coulomb's, mu = {:g}", test.pusher.friction) : ""));
  result.push_back("The wire is computed in its plane; the displacement is counted from the first touch of pusher and wire.");
  return result;
}

identification::PredictionOptions with_shapes(const Series& series, double offset, Console& console, const std::string& label) {
  identification::PredictionOptions result;
  const std::vector<double>& d = identification::measured_displacement(series);
  // Six shapes along the push, at displacements that are computed anyhow.
  for (int i = 0; i <= 5; ++i) {
    result.shapes_at.push_back(d[(d.size() - 1) * static_cast<std::size_t>(i) / 5] - offset);
  }
  result.progress = [&console, label, &series](double travel) {
    console.progress(fmt::format("{}, {}: {:.3f} mm", label, series.name, 1e3 * travel));
    return !interrupted();
  };
  return result;
}

/// The curves of a model with these settings, with shapes.
std::vector<Prediction> curves_of(const Experiment& experiment, const std::vector<identification::Setting>& settings,
                                  Console& console, const std::string& label) {
  const identification::Model::Applied applied =
      identification::Model(experiment.series, experiment.solver, false).apply(settings);
  std::vector<Prediction> result;
  for (std::size_t k = 0; k < applied.series.size(); ++k) {
    result.push_back(identification::predict(applied.series[k], experiment.solver, applied.reading[k],
                                             with_shapes(experiment.series[k], applied.reading[k].displacement_offset,
                                                         console, label)));
  }
  return result;
}

/// One wire fitted to the published laws themselves, without noise. Weights are shifted to the position that is worst off
/// against its published scatter until all are within, or for a few rounds.
identification::Trace balanced_fit(Experiment experiment, const std::function<bool(const std::string&)>& progress) {
  identification::TraceOptions options;
  options.most_effects = 0;
  options.attribute = false;
  options.intervals = false;
  options.draw = false;
  options.progress = progress;
  constexpr int rounds = 5;
  identification::Trace best;
  double lowest = std::numeric_limits<double>::max();
  for (int k = 0; k < rounds; ++k) {
    identification::Trace fitted = identification::trace(experiment, options);
    if (!fitted.report.usable()) return k == 0 ? fitted : best;
    double worst = 0.0;
    for (std::size_t i = 0; i < experiment.series.size(); ++i) {
      Series& s = experiment.series[i];
      if (!s.law || s.law->scatter() <= 0.0) continue;
      const double ratio = fitted.final.series_rmse[i] / s.law->scatter();
      worst = std::max(worst, ratio);
      s.force_sigma = s.force_sigma.value_or(s.law->scatter()) / std::clamp(ratio, 0.5, 2.0);
    }
    const bool interrupted_now = fitted.interrupted;
    if (worst < lowest) {
      lowest = worst;
      best = std::move(fitted);
    }
    if (worst <= 1.0 || interrupted_now) break;
  }
  return best;
}

/// What the tracing says when the unprinted range of the fits is taken to be another one.
json verdict_at(const Experiment& experiment, double to, const std::function<bool(const std::string&)>& progress) {
  Experiment other = experiment;
  for (Series& s : other.series) {
    if (!s.law) continue;
    const std::size_t points = s.test.travel.size();
    s.law->to = to;
    for (std::size_t i = 0; i < points; ++i) s.test.travel[i] = to * static_cast<double>(i) / static_cast<double>(points - 1);
  }
  json result{{"to_mm", 1e3 * to}};
  const identification::Trace fitted = balanced_fit(other, progress);
  json rms = json::object();
  bool within = fitted.report.usable();
  for (std::size_t k = 0; k < other.series.size() && fitted.report.usable(); ++k) {
    const Series& s = other.series[k];
    if (!s.law) continue;
    rms[s.name] = {{"rmse_N", fitted.final.series_rmse[k]}, {"scatter_N", s.law->scatter()}};
    within = within && fitted.final.series_rmse[k] <= s.law->scatter();
  }
  result["fit"] = rms;
  result["numbers"] = experiment.free.size();
  result["within_scatter"] = within;
  identification::TraceOptions tracing;
  tracing.intervals = false;
  tracing.progress = progress;
  const identification::Trace traced = identification::trace(other, tracing);
  if (!traced.report.usable()) {
    result["verdict"] = "not computed: " + traced.report.message;
    return result;
  }
  result["verdict"] = verdict(traced);
  result["selected"] = traced.selected;
  result["explained"] = traced.explained;
  result["chi2_dof"] = {{"base", traced.base.chi2_dof}, {"final", traced.final.chi2_dof}};
  return result;
}

/// Fitted numbers as the page shows them.
json parameters_json(const std::vector<identification::FittedNumber>& numbers) {
  json result = json::object();
  for (const identification::FittedNumber& n : numbers) {
    result[n.key] = {{"value", n.value}, {"stderr", n.standard_error ? json(*n.standard_error) : json()}, {"unit", n.unit}};
  }
  return result;
}

std::string error_table(const json& result) {
  std::string text = fmt::format("{:<12}{:>14}{:>14}{:>10}\n", "position", "model", "rmse [N]", "nrmse");
  for (const json& series : result["series"]) {
    for (const auto& [name, model] : series["models"].items()) {
      text += fmt::format("{:<12}{:>14}{:>14.3f}{:>10.4f}\n", series["name"].get<std::string>(), name,
                          model["rmse_N"].get<double>(), model["nrmse"].get<double>());
    }
  }
  return text;
}

}  // namespace

ExitStatus run_reproduce(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const Experiment experiment = open_experiment(
      file.empty() ? data_directory() / "experiments" / "published_static.toml" : file, options);
  for (const Series& series : experiment.series) {
    if (identification::measured_force(series).empty()) {
      throw base::InputError({experiment.file.string(), 0, "series[" + series.name + "]", "",
                                  "must have readings or a law to reproduce"});
    }
  }

  std::vector<ModelCurves> models;
  ModelCurves declared;
  declared.name = "declared";
  declared.label = "declared model";
  declared.description = "The wire, mounts and pusher exactly as the experiment file declares them; nothing fitted";
  declared.parameters = json::object();
  for (const char* key : {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N", "wire.length_mm"}) {
    const identification::Parameter& p = identification::parameter(key);
    declared.parameters[key] = {{"value", p.shown(p.get(experiment.series.front().test, {}), 0.0)}, {"stderr", nullptr}, {"unit", p.unit}};
  }
  declared.predictions = curves_of(experiment, {}, console, "declared model");
  for (const Series& s : experiment.series) declared.radius_mm.push_back(1e3 * s.test.pusher.radius);
  models.push_back(declared);

  ExitStatus status = ExitStatus::done;
  const auto progress = [&console](const std::string& stage) {
    console.progress(stage);
    return !interrupted();
  };
  json traced = nullptr;
  json verdicts = json::array();
  const auto add_model = [&](const identification::Trace& trace, const char* name, const char* label, const char* description) {
    if (!trace.report.usable()) {
      console.complain(fmt::format("{}: {}", label, trace.report.message));
      status = ExitStatus::solver_stopped;
      return;
    }
    ModelCurves model = declared;
    model.name = name;
    model.label = label;
    model.description = description;
    model.parameters = parameters_json(trace.final.numbers);
    model.free = static_cast<int>(trace.final.numbers.size());
    model.predictions = curves_of(experiment, trace.final_settings, console, label);
    models.push_back(std::move(model));
  };
  if (!interrupted()) {
    add_model(balanced_fit(experiment, progress), "best_fit", "best fit of the declared kind",
              "The same kind of model with the listed numbers fitted to all positions together, no position left behind");
  }
  if (!interrupted()) {
    identification::TraceOptions tracing;
    tracing.progress = progress;
    const identification::Trace trace = identification::trace(experiment, tracing);
    if (trace.report.usable()) {
      traced = trace_json(experiment, trace);
      traced.erase("series");
      if (!trace.selected.empty()) {
        add_model(trace, "traced", "traced model", "The fitted model with the effect that the tracing adds");
      }
    }
    const bool laws = std::any_of(experiment.series.begin(), experiment.series.end(), [](const Series& s) { return s.law.has_value(); });
    for (const double to : {3e-3, 4e-3, 5e-3, 18e-3}) {
      if (!laws || interrupted()) break;
      verdicts.push_back(verdict_at(experiment, to, [&](const std::string& stage) {
        return progress(fmt::format("range {:g} mm: {}", 1e3 * to, stage));
      }));
    }
  }
  console.end_progress();

  const coupling::PushProblem& test = experiment.series.front().test;
  json result{{"schema", "snare-reproduce/1"},
              {"title", experiment.title},
              {"source", experiment.source},
              {"version", version()},
              {"assumptions", assumptions(experiment)},
              {"wire",
               {{"diameter_mm", 1e3 * test.wire.diameter},
                {"length_mm", 1e3 * test.wire.length},
                {"span_mm", 1e3 * test.mount.span},
                {"bending_stiffness_Nm2", test.wire.bending_stiffness()},
                {"axial_stiffness_N", test.wire.axial_stiffness()}}},
              {"trace", traced},
              {"verdicts", verdicts},
              {"models", json::array()},
              {"series", json::array()}};
  for (const ModelCurves& model : models) {
    result["models"].push_back(model_json(experiment, model));
    for (std::size_t k = 0; k < experiment.series.size(); ++k) {
      const numerics::SolveReport& report = model.predictions[k].curve.curve.report;
      if (report.usable()) continue;
      console.complain(fmt::format("{}, series {}: {}", model.label, experiment.series[k].name, report.message));
      status = ExitStatus::solver_stopped;
    }
  }
  for (std::size_t k = 0; k < experiment.series.size(); ++k) {
    result["series"].push_back(series_json(experiment.series[k], models, k));
  }

  std::vector<CurveColumn> columns{{"measured_N", {}}, {"base_N", {}}, {"final_N", {}}};
  for (std::size_t k = 0; k < experiment.series.size(); ++k) {
    columns[0].values.push_back(identification::measured_force(experiment.series[k]));
    columns[1].values.push_back(models.front().predictions[k].force);
    columns[2].values.push_back(models.back().predictions[k].force);
  }
  write_curves(options.out / "curves.csv", experiment.series, models.front().predictions, columns);
  base::write_text(options.out / "reproduce.json", result.dump(1) + "\n");
  base::write_text(options.out / "report.html", reproduce_report_html(result));
  if (options.json) {
    std::cout << result.dump(1) << '\n';
  } else {
    console.say(error_table(result));
    for (const json& v : verdicts) {
      console.say(fmt::format("if the fits reach to {:g} mm: {}", v["to_mm"].get<double>(), v["verdict"].get<std::string>()));
    }
    console.say(fmt::format("wrote {0}/curves.csv, {0}/reproduce.json, {0}/report.html", options.out.string()));
  }
  return status;
}

}  // namespace snare::app
