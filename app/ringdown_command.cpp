#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/report/ring_down_report.hpp"
#include "app/result_folder.hpp"
#include "base/csv.hpp"
#include "base/files.hpp"
#include "identification/ring_down/mode_match.hpp"
#include "results/finite_json.hpp"
#include "results/in_mm.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <numbers>

namespace snare::app {

namespace {

using identification::DampingSplit;
using identification::Estimate;
using identification::RingDownFile;
using identification::RingDownFit;
using identification::RingDownMode;
using nlohmann::json;

json estimate_json(const Estimate& e, double unit = 1.0) {
  return {{"value", unit * e.value},
          {"stderr", results::finite(unit * e.error)},
          {"lower", results::finite(unit * e.lower())},
          {"upper", results::finite(unit * e.upper())}};
}

json series_json(const identification::RingDown& data, const RingDownFit& fit) {
  json modes = json::array();
  const double duration = data.time[data.time.size() - 1] - data.time[0];
  for (const RingDownMode& m : fit.modes) {
    modes.push_back({{"frequency_Hz", estimate_json(m.frequency)},
                     {"decay_1_s", estimate_json(m.decay)},
                     {"damping_ratio", estimate_json(m.damping_ratio)},
                     {"amplitude_mm", estimate_json(m.amplitude, per_mm)},
                     {"periods", m.frequency.value * duration},
                     {"significant", m.significant()}});
  }
  return {{"name", data.name},
          {"converged", fit.report.usable()},
          {"modes", modes},
          {"friction_mm_s", fit.friction ? estimate_json(*fit.friction, per_mm) : json()},
          {"friction_bic", fit.friction_bic},
          {"rmse_mm", per_mm * fit.rmse},
          {"nrmse", fit.nrmse},
          {"residual",
           {{"noise_only", fit.noise_only()}, {"runs_p", fit.runs_p}, {"ljung_box_p", fit.ljung_box_p}}}};
}

/// What must not be relied on, of the records and of what they give together.
std::vector<std::string> warnings_of(const RingDownFile& file, const std::vector<RingDownFit>& fits,
                                     const DampingSplit& split) {
  std::vector<std::string> warnings;
  for (std::size_t s = 0; s < fits.size(); ++s) {
    const std::string& name = file.series[s].data.name;
    if (!fits[s].report.usable())
      warnings.push_back(fmt::format("{}: the fit did not converge {}", name, fits[s].report.message));
    if (!fits[s].noise_only())
      warnings.push_back(name + ": the residual has a pattern, so the errors are too small");
  }
  warnings.insert(warnings.end(), split.warnings.begin(), split.warnings.end());
  return warnings;
}

/// Of one of the two numbers; where only their sum is known, neither has an interval.
json share_json(const DampingSplit& split, Estimate share) {
  if (!split.separated) share.error = std::numeric_limits<double>::infinity();
  return estimate_json(share);
}

json damping_json(const DampingSplit& split) {
  return {{"separated", split.separated},
          {"bending_time_s", share_json(split, split.bending_time)},
          {"mass_rate_1_s", share_json(split, split.mass_rate)},
          {"correlation", split.correlation},
          {"misfit_p", split.misfit_p},
          {"misfit_dof", split.misfit_dof},
          {"statement", split.statement}};
}

}  // namespace

ExitStatus run_ringdown(const std::filesystem::path& path, const CommonOptions& options, Console& console) {
  const RingDownFile file = identification::read_ring_down_file(path, overrides_of(options));
  const ResultFolder folder(options, {"ringdown.json", "ringdown.csv", "report.html"});
  std::vector<RingDownFit> fits;
  ExitStatus status = ExitStatus::done;
  json result{{"schema", "snare-ringdown-result/1"},
              {"interrupted", false},
              {"title", file.title},
              {"source", file.source},
              {"series", json::array()}};
  for (const identification::RingDownSeries& s : file.series) {
    console.progress(fmt::format("fitting {}", s.data.name));
    fits.push_back(identification::fit_ring_down(s.data));
    result["series"].push_back(series_json(s.data, fits.back()));
    if (fits.back().report.usable()) continue;
    console.complain(fmt::format("{}: the fit did not converge {}", s.data.name, fits.back().report.message));
    status = ExitStatus::solver_stopped;
  }
  console.end_progress();
  set_stage("matching the modes");
  const std::vector<identification::MatchedMode> modes = identification::match_modes(file, fits);
  for (const identification::MatchedMode& m : modes) {
    json& one = result["series"][m.series]["modes"][m.mode];
    one["bending_share"] = m.decay.bending_share;
    one["computed_Hz"] = m.computed > 0.0 ? json(m.computed / (2.0 * std::numbers::pi)) : json();
    one["computed_error_Hz"] = m.computed_error ? json(*m.computed_error) : json();
  }
  const DampingSplit split = identification::split_damping(modes);
  result["damping"] = damping_json(split);
  const std::vector<std::string> warnings = warnings_of(file, fits, split);
  result["warnings"] = warnings;
  begin_writing();
  base::CsvWriter csv(options.out / "ringdown.csv", {"series", "time_s", "measured_mm", "fitted_mm"});
  for (std::size_t s = 0; s < fits.size(); ++s) {
    const identification::RingDown& data = file.series[s].data;
    for (Eigen::Index i = 0; i < data.time.size(); ++i) {
      csv.row({std::string_view(data.name), data.time[i], results::in_mm(data.displacement[i]),
               results::in_mm(fits[s].fitted[i])});
    }
  }
  csv.commit();
  base::write_text(options.out / "report.html", ring_down_report_html(file, fits, split, warnings));
  write_result(options, "ringdown.json", result);
  if (options.json) return status;
  for (std::size_t s = 0; s < fits.size(); ++s) {
    for (const RingDownMode& m : fits[s].modes) {
      console.say(fmt::format("{}: {} Hz, damping ratio {}{}", file.series[s].data.name,
                              with_error(m.frequency), with_error(m.damping_ratio),
                              m.significant() ? "" : " (does not stand out of the noise)"));
    }
    if (fits[s].friction)
      console.say(fmt::format("{}: friction takes {} mm of amplitude a second besides",
                              file.series[s].data.name, with_error(*fits[s].friction, per_mm)));
  }
  if (split.separated)
    console.say(fmt::format("bending_time_s = {}, mass_rate_1_s = {}", with_error(split.bending_time),
                            with_error(split.mass_rate)));
  console.say(split.statement);
  for (const std::string& warning : warnings) console.say("warning: " + warning);
  console.say(fmt::format("wrote {0}/ringdown.json, ringdown.csv, report.html", options.out.string()));
  return status;
}

}  // namespace snare::app
