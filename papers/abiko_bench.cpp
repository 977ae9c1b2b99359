#include "papers/abiko_bench.hpp"

#include "coupling/statics/push_solver.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/experiment.hpp"
#include "identification/published/fit_ranges.hpp"
#include "reduction/law_fit.hpp"
#include "results/in_mm.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

namespace snare::papers {

using identification::Series;
using results::in_mm;
using validation::Limit;

namespace {

constexpr auto measurement = validation::Kind::published_measurement;

/// The pushes at the three positions.
struct Pushes {
  identification::Experiment experiment;      ///< declared wire, published laws
  std::vector<coupling::PushCurve> declared;  ///< one a series
  std::vector<std::vector<double>> travel,
      traced_force;  ///< displacement [m] and force of the traced wire [N], one a series
  std::vector<reduction::FittedLaw> traced_law;  ///< quadratic through the traced wire's curve, one a series
};

coupling::PushCurve pushed(const coupling::PushProblem& test, const Runs& runs) {
  coupling::PushOptions options;
  options.stop = [&runs] { return runs.watch().stopped(); };
  options.shapes_at = {0.0, test.travel.back()};
  coupling::PushCurve curve = coupling::solve_push_extrapolated(test, options).curve;
  runs.go_on();
  if (!curve.report.usable()) throw std::runtime_error(curve.report.message);
  return curve;
}

/// Force of the traced wire at the displacements of a series, which are counted from the zero that was fitted
/// with it.
std::vector<double> recorded(const reduction::WireCase& wire, std::size_t k, const Series& series,
                             const Runs& runs) {
  coupling::PushProblem test = wire.test;
  test.contact_position = series.test.contact_position;
  const double zero = wire.law_offsets.at(k);
  std::vector<double> force;
  for (const double d : series.test.travel) {
    if (d < zero)
      force.push_back(0.0);
    else
      test.travel.push_back(d - zero);
  }
  for (const coupling::PushPoint& p : pushed(test, runs).points) force.push_back(p.force);
  return force;
}

const Pushes& pushes(Runs& runs) {
  return runs.once<Pushes>("push on the declared and the traced wire", [&runs] {
    Pushes result;
    result.experiment = identification::read_experiment(runs.data() / "experiments/published_static.toml",
                                                        identification::parameters());
    reduction::WireCase wire = traced_wire(runs);
    wire.test.travel.clear();
    for (Series& series : result.experiment.series) {  // over the range of the traced wire
      const double longer = wire.travel.high / series.law->to;
      series.law->to = wire.travel.high;
      for (double& d : series.test.travel) d *= longer;
    }
    for (std::size_t k = 0; k < result.experiment.series.size(); ++k) {
      const Series& series = result.experiment.series[k];
      result.declared.push_back(pushed(series.test, runs));
      result.travel.push_back(series.test.travel);
      result.traced_force.push_back(recorded(wire, k, series, runs));
      std::vector<std::size_t> all(series.test.travel.size());
      std::iota(all.begin(), all.end(), 0);
      result.traced_law.push_back(
          reduction::fit_law(coupling::quadratic_law(),
                             numerics::HermiteCurve(series.test.travel, result.traced_force[k]), all));
    }
    return result;
  });
}

std::string at(const Series& series) {
  return fmt::format("s = {:g} mm", 1e3 * series.test.contact_position);
}

}  // namespace

reduction::WireCase traced_wire(const Runs& runs) {
  return reduction::read_wire_file(runs.data() / "wires/traced_published.toml").cases.front();
}

FigureResult conditions_of_the_wire(Runs& runs) {
  const auto& series = pushes(runs).experiment.series;
  const coupling::PushProblem& test = series.front().test;
  FigureResult result =
      inputs({{"diameter", "mm", 1.5, 1e3 * test.wire.diameter, 0.1},
              {"length", "mm", 180.0, 1e3 * test.wire.length, 1.0},
              {"fixed length", "mm", 175.0, 1e3 * test.mount.span, 1.0},
              {"contact position, first", "mm", 40.0, 1e3 * series[0].test.contact_position, 1.0},
              {"contact position, second", "mm", 65.0, 1e3 * series[1].test.contact_position, 1.0},
              {"contact position, third", "mm", 90.0, 1e3 * series[2].test.contact_position, 1.0}},
             measurement);
  result.findings.push_back(fmt::format(
      "A solid round wire of these numbers and of 193 GPa has a bending stiffness of {} N m^2 and an axial "
      "stiffness of {} kN.",
      digits(test.wire.bending_stiffness(), 3), digits(1e-3 * test.wire.axial_stiffness(), 3)));
  return result;
}

FigureResult largest_displacement(Runs& runs) {
  const Pushes& p = pushes(runs);
  std::vector<double> touch;
  for (const coupling::PushCurve& curve : p.declared)
    touch.push_back(curve.touch_height + p.experiment.series.front().test.pusher.radius);
  const identification::FitRanges limits(p.experiment.series, touch, {.bins = 1, .readings = {6}});
  std::vector<double> height;
  for (const identification::FitRange& range : limits.ranges())
    if (range.kind == identification::FitRange::Kind::taut_from_chord) height = range.to;
  if (height.empty()) throw std::runtime_error("the declared wire is taut before it is pushed");
  FigureResult result;
  result.table.columns = {"contact position [mm]", "height of the loose wire [mm]",
                          "height of the taut wire [mm]", "distance between them [mm]"};
  const std::vector<double> ends{0.0, 1e3 * p.experiment.series.front().test.mount.span};
  for (std::size_t k = 0; k < p.declared.size(); ++k) {
    const Series& series = p.experiment.series[k];
    const double s = 1e3 * series.test.contact_position, rest = 1e3 * p.declared[k].natural_height,
                 q = 1e3 * height[k];
    result.table.rows.push_back({digits(s), digits(rest), digits(q), digits(q - rest)});
    if (k == 0)
      result.curves.push_back({"loose wire", Origin::computed, in_mm(p.declared[k].shapes.front().x),
                               in_mm(p.declared[k].shapes.front().y)});
    result.curves.push_back({"taut, " + at(series), Origin::computed, {ends[0], s, ends[1]}, {0.0, q, 0.0}});
  }
  return result;
}

FigureResult forces_at_three_positions(Runs& runs) {
  const Pushes& p = pushes(runs);
  FigureResult result;
  for (std::size_t k = 0; k < p.travel.size(); ++k) {
    const Series& series = p.experiment.series[k];
    FigureCurve published{"published fit, " + at(series), Origin::published, in_mm(p.travel[k])};
    published.scatter = series.law->scatter();
    FigureCurve declared{"declared wire, " + at(series), Origin::computed};
    for (const double d : p.travel[k]) published.y.push_back(series.law->force(d));
    for (const coupling::PushPoint& point : p.declared[k].points) {
      declared.x.push_back(1e3 * point.travel);
      declared.y.push_back(point.force);
    }
    result.curves.push_back(std::move(published));
    result.curves.push_back(
        {"traced wire, " + at(series), Origin::computed, in_mm(p.travel[k]), p.traced_force[k]});
    result.curves.push_back(std::move(declared));
  }
  return result;
}

FigureResult quadratic_fits(Runs& runs) {
  const Pushes& p = pushes(runs);
  FigureResult result;
  result.table.columns = {"s [mm]",    "A printed",  "A computed",         "B printed",  "B computed",
                          "C printed", "C computed", "rms difference [N]", "scatter [N]"};
  for (std::size_t k = 0; k < p.travel.size(); ++k) {
    const identification::QuadraticLaw& law = *p.experiment.series[k].law;
    const reduction::FittedLaw& traced = p.traced_law[k];
    double apart = 0.0;
    for (const double d : p.travel[k])
      apart += std::pow(traced.form->force(traced.values, d) - law.force(d), 2) /
               static_cast<double>(p.travel[k].size());
    apart = std::sqrt(apart);
    result.table.rows.push_back({digits(1e3 * p.experiment.series[k].test.contact_position), digits(law.a, 6),
                                 digits(traced.values[0], 6), digits(law.b), digits(traced.values[1]),
                                 digits(law.c), digits(traced.values[2]), digits(apart, 2),
                                 digits(law.scatter(), 2)});
    result.rows.push_back(
        {"",
         fmt::format("quadratic of the traced wire at {}: rms to the printed one over its scatter, at most 1",
                     at(p.experiment.series[k])),
         "", "", measurement, 0.0, apart / law.scatter(),
         Limit::absolute(
             1.0, "an upper bound; the value is a multiple of the scatter of the published readings")});
  }
  return result;
}

FigureResult stiffness_at_three_positions(Runs& runs) {
  const Pushes& p = pushes(runs);
  FigureResult result;
  std::vector<double> last;
  constexpr double least = 0.1e-3;  // [m]: towards zero the offset C over the displacement is without bound
  for (std::size_t k = 0; k < p.travel.size(); ++k) {
    const Series& series = p.experiment.series[k];
    const numerics::HermiteCurve curve(p.travel[k], p.traced_force[k]);
    FigureCurve curves[4]{{"published fit, " + at(series), Origin::published},
                          {"traced wire, " + at(series), Origin::computed},
                          {"published fit, " + at(series), Origin::published},
                          {"traced wire, " + at(series), Origin::computed}};
    double falls = 0.0, before = 0.0;
    for (const double d : p.travel[k]) {
      if (d < least) continue;
      const double secant = curve.value(d) / d;
      const double values[4]{series.law->force(d) / d, secant, 2.0 * series.law->a * d + series.law->b,
                             curve.slope(d)};
      for (std::size_t i = 0; i < 4; ++i) {
        curves[i].x.push_back(1e3 * d);
        curves[i].y.push_back(1e-3 * values[i]);
        curves[i].panel = i / 2;
      }
      if (secant < before) falls += 1.0;
      before = secant;
    }
    const double end = p.travel[k].back();
    last.push_back(curve.value(end) / end);
    for (FigureCurve& one : curves) result.curves.push_back(std::move(one));
    result.rows.push_back(
        {"", fmt::format("secant stiffness at {}, {:g} mm", at(series), 1e3 * end), "N/m",
         "Abiko et al., Table 4", measurement, series.law->force(end) / end, last.back(),
         Limit::absolute(2.0 * series.law->scatter() / end,
                         "two standard deviations of a published reading over the displacement")});
    result.rows.push_back(
        {"", fmt::format("larger displacement, larger stiffness at {}: points that fall", at(series)), "",
         "Abiko et al., section 4.2", measurement, 0.0, falls,
         Limit::absolute(0.5, "a number of points, of which there should be none")});
  }
  result.rows.push_back(statement(
      fmt::format("stiffness falls from s = 40 over 65 to 90 mm at {:g} mm", 1e3 * p.travel[0].back()),
      measurement, last[0] > last[1] && last[1] > last[2]));
  return result;
}

}  // namespace snare::papers
