#include "app/report/ring_down_report.hpp"

#include "app/report/report_page.hpp"
#include "results/version.hpp"

#include <fmt/format.h>

#include <cmath>

namespace snare::app {

using namespace results;

using identification::DampingSplit;
using identification::RingDownFile;
using identification::RingDownFit;
using identification::RingDownMode;

std::string with_error(const identification::Estimate& e, double unit) {
  if (!std::isfinite(e.error)) return fmt::format("{:.5g}, not determined", unit * e.value);
  return fmt::format("{:.5g} -+ {:.2g}", unit * e.value, unit * 1.96 * e.error);
}

std::string ring_down_report_html(const RingDownFile& file, const std::vector<RingDownFit>& fits,
                                  const DampingSplit& split, const std::vector<std::string>& warnings) {
  ReportPage page(file.title, file.source);
  page.heading("Damping");
  page.callout(split.statement, !split.consistent() ? Tone::bad : split.separated ? Tone::good : Tone::plain);
  for (const std::string& warning : warnings) page.callout(warning, Tone::bad);
  const std::string kind = split.consistent() ? "95 %" : "95 %, with the scatter between the decays";
  page.key_figures({{"bending_time", with_error(split.bending_time) + " s",
                     split.separated ? kind : "if all were material"},
                    {"mass_rate", with_error(split.mass_rate) + " 1/s",
                     split.separated ? kind : "if all were mass-proportional"}});
  Table table{"",
              {"Series"_code, "Frequency [Hz]"_number, "Damping ratio"_number, "Decay [1/s]"_number,
               "Amplitude [mm]"_number, "Friction [mm/s]"_number}};
  for (std::size_t s = 0; s < fits.size(); ++s) {
    for (std::size_t m = 0; m < fits[s].modes.size(); ++m) {
      const RingDownMode& mode = fits[s].modes[m];
      const bool rubs = fits[s].friction && m == fits[s].largest;
      table.rows.push_back({file.series[s].data.name, with_error(mode.frequency),
                            with_error(mode.damping_ratio), with_error(mode.decay),
                            with_error(mode.amplitude, per_mm),
                            rubs ? with_error(*fits[s].friction, per_mm) : std::string("none seen")});
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

}  // namespace snare::app
