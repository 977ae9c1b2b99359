#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/report/report_page.hpp"
#include "base/csv.hpp"
#include "base/files.hpp"
#include "identification/ring_down/mode_match.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <iostream>
#include <numbers>

namespace snare::app {

namespace {

using identification::DampingSplit;
using identification::Estimate;
using identification::RingDownFile;
using identification::RingDownFit;
using identification::RingDownMode;
using nlohmann::json;

constexpr double per_mm = 1e3;

json estimate_json(const Estimate& e, double unit = 1.0) {
  return {
      {"value", unit * e.value}, {"stderr", unit * e.error}, {"lower", unit * e.lower()}, {"upper", unit * e.upper()}};
}

std::string with_error(const Estimate& e, double unit = 1.0) {
  return fmt::format("{:.5g} -+ {:.2g}", unit * e.value, unit * 1.96 * e.error);
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
          {"residual", {{"noise_only", fit.noise_only()}, {"runs_p", fit.runs_p}, {"ljung_box_p", fit.ljung_box_p}}}};
}

json damping_json(const DampingSplit& split) {
  return {{"separated", split.separated},
          {"bending_time_s", estimate_json(split.bending_time)},
          {"mass_rate_1_s", estimate_json(split.mass_rate)},
          {"correlation", split.correlation},
          {"misfit_p", split.misfit_p},
          {"statement", split.statement}};
}

std::string report_of(const RingDownFile& file, const std::vector<RingDownFit>& fits, const DampingSplit& split) {
  ReportPage page(file.title, file.source);
  page.heading("Damping");
  page.callout(split.statement, split.separated ? Tone::good : Tone::plain);
  page.key_figures(
      {{"bending_time", with_error(split.bending_time) + " s", split.separated ? "95 %" : "if all were material"},
       {"mass_rate", with_error(split.mass_rate) + " 1/s",
        split.separated ? "95 %" : "if all were mass-proportional"}});
  Table table{"",
              {{"Series", ColumnKind::code},
               {"Frequency [Hz]", ColumnKind::number},
               {"Damping ratio", ColumnKind::number},
               {"Decay [1/s]", ColumnKind::number},
               {"Amplitude [mm]", ColumnKind::number},
               {"Friction [mm/s]", ColumnKind::number}},
              {}};
  for (std::size_t s = 0; s < fits.size(); ++s) {
    for (std::size_t m = 0; m < fits[s].modes.size(); ++m) {
      const RingDownMode& mode = fits[s].modes[m];
      const bool rubs = fits[s].friction && m == fits[s].largest;
      table.rows.push_back({file.series[s].data.name, with_error(mode.frequency), with_error(mode.damping_ratio),
                            with_error(mode.decay), with_error(mode.amplitude, per_mm),
                            rubs ? with_error(*fits[s].friction, per_mm) : std::string("none seen")});
    }
    if (!fits[s].noise_only()) {
      page.callout(file.series[s].data.name + ": what is left is no noise, so the errors are too small", Tone::bad);
    }
  }
  page.table(table);
  page.heading("Ring-downs");
  for (std::size_t s = 0; s < fits.size(); ++s) {
    const identification::RingDown& data = file.series[s].data;
    PlotSpecification plot{data.name, {"time", "s"}, {"displacement", "mm"}};
    plot.width = PlotWidth::full;
    Curve measured{"measured", {}, {}, CurveStyle::points, 0};
    Curve fitted{"fitted", {}, {}, CurveStyle::line, 1};
    Curve left{"measured less fitted", {}, {}, CurveStyle::line, 2};
    for (Eigen::Index i = 0; i < data.time.size(); ++i) {
      for (Curve* c : {&measured, &fitted, &left}) c->x.push_back(data.time[i]);
      measured.y.push_back(per_mm * data.displacement[i]);
      fitted.y.push_back(per_mm * fits[s].fitted[i]);
      left.y.push_back(per_mm * (data.displacement[i] - fits[s].fitted[i]));
    }
    plot.curves = {measured, fitted, left};
    page.line_plot(plot);
  }
  page.footer(written_by(version(), "ringdown.json and ringdown.csv"));
  return page.html();
}

}  // namespace

ExitStatus run_ringdown(const std::filesystem::path& path, const CommonOptions& options, Console& console) {
  const RingDownFile file = identification::read_ring_down_file(path, overrides_of(options));
  std::vector<RingDownFit> fits;
  ExitStatus status = ExitStatus::done;
  json result{
      {"schema", "snare-ringdown-result/1"}, {"title", file.title}, {"source", file.source}, {"series", json::array()}};
  for (const identification::RingDownSeries& s : file.series) {
    fits.push_back(identification::fit_ring_down(s.data));
    result["series"].push_back(series_json(s.data, fits.back()));
    if (fits.back().report.usable()) continue;
    console.complain(fmt::format("{}: the fit did not converge {}", s.data.name, fits.back().report.message));
    status = ExitStatus::solver_stopped;
  }
  const std::vector<identification::MatchedMode> modes = identification::match_modes(file, fits);
  for (const identification::MatchedMode& m : modes) {
    json& one = result["series"][m.series]["modes"][m.mode];
    one["bending_share"] = m.decay.bending_share;
    one["computed_Hz"] = m.computed > 0.0 ? json(m.computed / (2.0 * std::numbers::pi)) : json();
  }
  const DampingSplit split = identification::split_damping(modes);
  result["damping"] = damping_json(split);
  base::write_text(options.out / "ringdown.json", result.dump(1) + "\n");
  base::CsvWriter csv(options.out / "ringdown.csv", {"series", "time_s", "measured_mm", "fitted_mm"});
  for (std::size_t s = 0; s < fits.size(); ++s) {
    const identification::RingDown& data = file.series[s].data;
    for (Eigen::Index i = 0; i < data.time.size(); ++i) {
      csv.row({std::string_view(data.name), data.time[i], per_mm * data.displacement[i], per_mm * fits[s].fitted[i]});
    }
  }
  csv.commit();
  base::write_text(options.out / "report.html", report_of(file, fits, split));
  if (options.json) {
    std::cout << result.dump(1) << '\n';
    return status;
  }
  for (std::size_t s = 0; s < fits.size(); ++s) {
    for (const RingDownMode& m : fits[s].modes) {
      console.say(fmt::format("{}: {} Hz, damping ratio {}{}", file.series[s].data.name, with_error(m.frequency),
                              with_error(m.damping_ratio),
                              m.significant() ? "" : " (does not stand out of the noise)"));
    }
    if (fits[s].friction)
      console.say(fmt::format("{}: friction takes {} mm of amplitude a second besides", file.series[s].data.name,
                              with_error(*fits[s].friction, per_mm)));
    if (!fits[s].noise_only())
      console.say(fmt::format("{}: what is left is no noise, so the errors are too small", file.series[s].data.name));
  }
  if (split.separated)
    console.say(fmt::format("bending_time_s = {}, mass_rate_1_s = {}", with_error(split.bending_time),
                            with_error(split.mass_rate)));
  console.say(split.statement);
  console.say(fmt::format("wrote {0}/ringdown.json, ringdown.csv, report.html", options.out.string()));
  return status;
}

}  // namespace snare::app
