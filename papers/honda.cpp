#include "base/units.hpp"
#include "coupling/contact/contact_law.hpp"
#include "identification/motion_tracing/trace_records.hpp"
#include "identification/records/record_file.hpp"
#include "papers/papers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace snare::papers {

namespace {

using base::degree;
using validation::Kind;
using validation::Limit;

constexpr auto measurement = Kind::published_measurement;
constexpr auto computation = Kind::published_computation;
constexpr double table_K_wire = 5.55e5, table_K_GF = 1.0e8,
                 table_rate = 29.0;  // [N/m], [N m/rad], [deg/s]: Table 4

// ---- the wire: Fig. 5, eqs (1) and (2) ----

FigureResult figure_5(Runs&) {
  constexpr double half_length = 0.090, half_span = 0.0875;  // [m]: assumed
  const coupling::ContactLaw exact = coupling::stretched_wire_law(table_K_wire, half_length, half_span),
                             linear = coupling::stretched_wire_tangent(table_K_wire, half_length, half_span);
  FigureCurve first{"eq. (1)"}, second{"eq. (2), linear"};
  constexpr int points = 50;
  constexpr double range = 10e-3;
  for (int i = 0; i <= points; ++i) {
    const double d = range * i / points;
    for (const auto& [curve, law] : {std::pair{&first, &exact}, std::pair{&second, &linear}}) {
      curve->x.push_back(1e3 * d);
      curve->y.push_back((*law)(d, 0.0)[0]);
    }
  }
  FigureResult result;
  result.findings.push_back(
      fmt::format("K_contact = {} N/m; at 10 mm eq. (1) gives {} times the force of eq. (2).",
                  digits(linear(1e-3, 0.0)[1], 5), digits(first.y.back() / second.y.back(), 3)));
  result.curves = {std::move(first), std::move(second)};
  return result;
}

// ---- the capture on the arm: Figs. 6 and 11, Tables 1 and 3 ----

/// The shipped capture with the shaft 20 mm off the axis, at rest, which the wires meet in the order of the
/// text.
Case capture(Runs&) {
  return {"scenarios/ssrms_htv_capture.toml",
          {"bodies[htv].position_mm=[-10.0,17.3205,5200.0]", "bodies[htv].velocity_m_s=[0.0,0.0,0.0]"}};
}

FigureResult table_1(Runs& runs) {
  const std::vector<coupling::MotionBody>& bodies =
      runs.of(capture(runs)).asked.motions.runs.front().motion.bodies;
  const auto found = std::ranges::find(bodies, "htv", &coupling::MotionBody::name);
  if (found == bodies.end()) throw std::out_of_range("no body \"htv\"");
  const double mass = found->properties.mass, along = found->properties.inertia(2, 2),
               across = found->properties.inertia(0, 0);
  // A uniform cylinder: I = m r^2/2 along its axis, m (3 r^2 + l^2)/12 across it.
  const double radius = std::sqrt(2.0 * along / mass),
               length = std::sqrt(12.0 * across / mass - 3.0 * radius * radius);
  return inputs({{"total weight", "t", 16.0, 1e-3 * mass, 1.0},
                 {"total length, of the cylinder with this inertia", "m", 9.8, length, 0.1},
                 {"diameter, of the same cylinder", "m", 4.4, 2.0 * radius, 0.1}},
                measurement);
}

Case flight(Runs&);

FigureResult table_3(Runs& runs) {
  const coupling::MotionFriction friction =
      runs.of({"scenarios/air_table.toml"}).asked.motions.runs.front().motion.contacts.front().friction;
  return inputs({{"static coefficient of friction", "", 0.3, friction.static_coefficient, 0.1},
                 {"dynamic coefficient of friction", "", 0.1, friction.dynamic_coefficient, 0.1},
                 {"stiction transition velocity", "m/s", 1.0e-2, friction.static_speed, 1e-3},
                 {"friction transition velocity", "m/s", 1.0, friction.dynamic_speed, 0.1}},
                computation);
}

FigureResult figure_6(Runs& runs) {
  const Run& run = runs.of(capture(runs));
  const auto [times, ring] = run.columns("time_s", "snare::ring motor_deg");
  const double touch = std::min({run.first_touch(0), run.first_touch(1), run.first_touch(2)});
  constexpr double begin = 0.4;  // the drive has reached its rate
  FigureCurve angle{"wire, turning about its fixed end"};
  double x0 = 0.0, y0 = 0.0, slope = 0.0, constancy = 0.0;
  std::vector<double> x, y;
  for (std::size_t i = 0; i < times.size(); ++i) {
    angle.x.push_back(times[i]);
    angle.y.push_back(0.5 * ring[i]);  // a chord turns by half of the angle at the centre
    if (times[i] < begin || times[i] > touch) continue;
    x.push_back(times[i]);
    y.push_back(0.5 * ring[i]);
  }
  if (x.size() < 2) throw std::runtime_error("a wire is touched before the ring has its rate");
  x0 = x.front();
  y0 = y.front();
  slope = (y.back() - y0) / (x.back() - x0);
  for (std::size_t i = 0; i < x.size(); ++i)
    constancy = std::max(constancy, std::abs(y[i] - y0 - slope * (x[i] - x0)));
  FigureResult result;
  result.findings.push_back(
      fmt::format("Before the first touch the angle differs from a straight line by {} deg at most.",
                  digits(constancy, 2)));
  result.rows.push_back({"", "rate at which a wire turns before the first touch", "deg/s",
                         "Honda et al., Table 4", computation, table_rate, slope + run.usable(),
                         Limit::absolute(0.5, "half of the last printed digit")});
  result.curves.push_back(std::move(angle));
  return result;
}

/// Time at which the last wire is tight [s].
double tight(const Run& run) {
  double last = 0.0;
  for (const coupling::WireUse& wire : run.result.wires) last = std::max(last, wire.tight_at);
  return last;
}

/// Start of the paper's clock, by which the shaft is tightened up at 29.2 s.
double clock_of_capture(const Run& run) {
  return tight(run) - 29.2;
}

FigureResult figure_11(Runs& runs) {
  const Run& run = runs.of(capture(runs));
  FigureResult result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.findings.push_back(
        fmt::format("Wire {}: first touch {} s before the shaft is tight, peak force on the shaft {} N.",
                    k + 1, digits(tight(run) - run.first_touch(k), 3), digits(run.result.peak_force[k], 3)));
  }
  result.rows.push_back(statement(
      "wire 1 collides first, then wire 2", computation,
      run.first_touch(0) + run.usable() < run.first_touch(1) && run.first_touch(1) < run.first_touch(2)));
  return result;
}

// ---- roll by K_GF and K_wire: Fig. 12, Table 4 ----

/// A flight with the end effector at rest; the fixture is held from 2 s on.
Case flight_with(double K_GF, double axial_stiffness) {
  return {"records/flight_scenario.toml",
          {"output_interval_s=0.005", fmt::format("bushings[gf].rotational_stiffness_Nm_rad={}", K_GF),
           fmt::format("snares[snare].wire.axial_stiffness_N={}", axial_stiffness)}};
}
constexpr double flight_half_length = 0.1;                      // of a wire [m]
constexpr double table_EA = table_K_wire * flight_half_length;  // [N]
Case flight(Runs&) {
  return flight_with(table_K_GF, table_EA);
}
Case half_K_GF(Runs&) {
  return flight_with(0.5 * table_K_GF, table_EA);
}
Case double_K_GF(Runs&) {
  return flight_with(2.0 * table_K_GF, table_EA);
}
Case half_K_wire(Runs&) {
  return flight_with(table_K_GF, 0.5 * table_EA);
}
Case double_K_wire(Runs&) {
  return flight_with(table_K_GF, 2.0 * table_EA);
}
constexpr double held_at = 2.0;  // [s]
/// Start of the paper's clock, by which the fixture counts as held from 29.5 s on.
double clock_of_flight(const Run&) {
  return held_at - 29.5;
}

FigureResult table_4(Runs& runs) {
  const coupling::Motion& motion = runs.of(flight(runs)).asked.motions.runs.front().motion;
  const double used = motion.law_wires.front().axial_stiffness / (0.5 * motion.law_wires.front().length);
  return inputs({{"stiffness of half a wire", "N/m", table_K_wire, used, 1e3},
                 {"stiffness of the base of the grapple fixture", "N m/rad", table_K_GF,
                  motion.bushings.front().rotational_stiffness.z(), 1e6}},
                computation);
}

/// Frequency of a vibration about its mean from a time on [Hz]: from the first upward crossing to the last.
double frequency(const std::vector<double>& times, const std::vector<double>& values, double from) {
  const auto begin = static_cast<std::size_t>(std::ranges::lower_bound(times, from) - times.begin());
  const double mean =
      std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(begin), values.end(), 0.0) /
      static_cast<double>(values.size() - begin);
  double first = 0.0, last = 0.0;
  int crossings = 0;
  for (std::size_t i = begin + 1; i < values.size(); ++i) {
    const double a = values[i - 1] - mean, b = values[i] - mean;
    if (a >= 0.0 || b < 0.0) continue;
    last = times[i - 1] - a / (b - a) * (times[i] - times[i - 1]);
    if (crossings++ == 0) first = last;
  }
  return crossings > 1 ? (crossings - 1) / (last - first) : validation::not_computed;
}

/// Root mean square difference of two roll rates [deg/s].
double apart(const Run& a, const Run& b) {
  const std::vector<double>&x = a.columns("time_s", "htv wz_rad_s").second,
        &y = b.columns("time_s", "htv wz_rad_s").second;
  const std::size_t n = std::min(x.size(), y.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
  return std::sqrt(sum / static_cast<double>(n)) / degree;
}

FigureResult figure_12(Runs& runs) {
  FigureResult result;
  result.table.columns = {"K_GF [N m/rad]", "roll [Hz]", "sqrt(K_GF/I)/(2 pi) [Hz]"};
  for (const auto asked : {half_K_GF, flight, double_K_GF}) {
    const Run& run = runs.of(asked(runs));
    const coupling::Motion& motion = run.asked.motions.runs.front().motion;
    const double K = motion.bushings.front().rotational_stiffness.z();
    const double expected =
        std::sqrt(K / motion.bodies.front().properties.inertia(2, 2)) / (2.0 * std::numbers::pi);
    const auto [times, rates] = run.columns("time_s", "htv wz_rad_s");
    const double found =
        frequency(times, rates, held_at + 0.3);  // 0.3 s: the joints that hold it have come to rest
    result.table.rows.push_back({digits(K), digits(found), digits(expected)});
    result.rows.push_back({"", fmt::format("frequency of the roll, K_GF = {:g} N m/rad", K), "Hz",
                           "sqrt(K_GF/I)/(2 pi)", Kind::closed_form, expected, found + run.usable(),
                           Limit::relative(5e-3)});
  }
  const Run& base = runs.of(flight(runs));
  const double by_wire = apart(runs.of(double_K_wire(runs)), base),
               by_gf = apart(runs.of(double_K_GF(runs)), base);
  result.findings.push_back(
      fmt::format("Doubled, K_GF changes the roll rate by {} deg/s rms, K_wire by {} deg/s.",
                  digits(by_gf, 2), digits(by_wire, 2)));
  result.rows.push_back(
      {"", "change of the roll rate by a doubled K_wire over that by a doubled K_GF, at most 1", "",
       "Honda et al., section 4.3: little effect", computation, 0.0, by_wire / by_gf,
       Limit::absolute(1.0,
                       "an upper bound for \"much larger effect\"; the value is a ratio of two changes")});
  return result;
}

// ---- two flights: Figs. 8 to 10 and 13 to 15 ----

/// The shipped flights with the numbers fitted to the first.
struct Flights {
  identification::RecordSet set;
  identification::RecordTrace trace;
};

const Flights& flights(Runs& runs) {
  return runs.once<Flights>("fit of three numbers to the first flight", [&runs] {
    Flights result{identification::read_records(runs.data() / "records/flight.toml"), {}};
    result.set.families.clear();
    identification::RecordTraceOptions options;
    options.effects = false;
    options.progress = [&runs](const std::string& stage) {
      runs.watch().say("honda, fit of a flight: " + stage);
      return !runs.watch().stopped();
    };
    result.trace = identification::trace_records(result.set, options);
    runs.go_on();
    if (!result.trace.report.usable()) throw std::runtime_error(result.trace.report.message);
    return result;
  });
}

/// Record and predictions of a rate of a flight.
template <std::size_t record, std::size_t channel>
FigureResult rate(Runs& runs) {
  const Flights& f = flights(runs);
  const identification::Record& flown = f.set.records.at(record);
  const Eigen::VectorXd times = flown.times.array() - (held_at - 29.5);
  const auto curve = [&times](const char* name, Origin origin, const Eigen::VectorXd& values) {
    return FigureCurve{name, origin, {times.begin(), times.end()}, {values.begin(), values.end()}};
  };
  const Eigen::VectorXd &read = flown.channels.at(channel).values,
                        &start = f.trace.declared.predictions.at(record).channels.at(channel),
                        &fitted = f.trace.base.predictions.at(record).channels.at(channel);
  const auto rms = [&read](const Eigen::VectorXd& values) {
    return (values - read).norm() / std::sqrt(static_cast<double>(read.size()));
  };
  const auto swing = [](const Eigen::VectorXd& values) { return values.maxCoeff() - values.minCoeff(); };
  FigureResult result;
  result.curves = {curve("synthetic record", Origin::record, read),
                   curve("numbers of Table 4", Origin::computed, start),
                   curve("fitted numbers", Origin::computed, fitted)};
  result.curves.front().scatter = flown.channels.at(channel).sigma.value_or(0.0);
  result.findings.push_back(fmt::format(
      "rms difference from the record: {} deg/s with the numbers of Table 4, {} deg/s with the fitted "
      "ones; noise {} deg/s. Range: record {}, fitted {} deg/s.",
      digits(rms(start), 3), digits(rms(fitted), 3), digits(result.curves.front().scatter, 3),
      digits(swing(read), 3), digits(swing(fitted), 3)));
  return result;
}

FigureResult fitted_numbers(Runs& runs) {
  const Flights& f = flights(runs);
  FigureResult result;
  result.table.columns = {"number", "unit", "fitted", "95 % from", "to"};
  for (const identification::TracedNumber& n : f.trace.base.numbers)
    result.table.rows.push_back({n.key, n.unit, digits(n.value), n.lower ? digits(*n.lower) : "open",
                                 n.upper ? digits(*n.upper) : "open"});
  result.findings.push_back(fmt::format("{} simulations; chi2 per degree of freedom {}.",
                                        f.trace.fit_simulations, digits(f.trace.base.chi2_dof, 3)));
  return result;
}

const Axis time{"time of the paper's clock", "s"}, rates{"angular velocity", "deg/s"};
constexpr const char* group = "numbers of a capture from three rates of a flight";
constexpr const char* flight_method =
    "`data/records/flight.toml`: no telemetry is public. The record is synthetic, by full wires with known "
    "numbers; "
    "the model has strings. Three numbers are "
    "fitted to the first flight by all three rates. Roll is about the visitor's axis.";
constexpr const char* second_method =
    "`data/records/flight.toml`, second flight, of another drift: predicted with the numbers of the first, "
    "nothing "
    "fitted.";
const auto one = [](const char* title) { return std::vector<Panel>{{title, time, rates}}; };
const auto roll = [](const char* name, Case (*run)(Runs&), std::size_t panel) {
  return HistoryCurve{name, run, "htv wz_rad_s", panel, 1.0 / degree, "time_s", clock_of_flight};
};

std::vector<Figure> declared_figures() {
  return {
      {"Table 1",
       "Major parameters of the HTV",
       "Weight, length and diameter.",
       "Read back from `data/scenarios/ssrms_htv_capture.toml`; its inertia is that of a uniform cylinder.",
       {},
       {},
       table_1},
      {"Fig. 5",
       "Contact force between wire and shaft",
       "A stretched wire without slack, fixed at both ends; linear for small displacements.",
       "Eqs (1) and (2) as repaired from the garbled text, with K_wire of Table 4. Assumed: l = 90 mm, L = "
       "87.5 mm.",
       {{"Contact force", {"displacement", "mm"}, {"force", "N"}}},
       {},
       figure_5,
       "distilled laws"},
      {"Fig. 6",
       "Moving speed of the snare wires",
       "Measured on a mock-up: nearly constant where the mechanism is driven at a constant rate.",
       "scenario `data/scenarios/ssrms_htv_capture.toml`: the ring is driven by a servo of limited torque.",
       {{"Angle of a wire", {"time", "s"}, {"angle", "deg"}}},
       {},
       figure_6},
      {"Table 3",
       "Friction between fixture and wire",
       "Coefficients and transition velocities of a smooth law.",
       "Read back from `data/scenarios/air_table.toml`; every shipped capture uses these coefficients.",
       {},
       {},
       table_3},
      {"Table 4",
       "Initial values of the optimisation",
       "K_wire, K_GF and the rate of the wires (Fig. 6).",
       "Read back from `data/records/flight_scenario.toml`. K_GF is printed in N/rad and used in N m/rad.",
       {},
       {},
       table_4},
      {"Section 4.2",
       "Numbers fitted to the first flight",
       "A simplex minimises the squares of the differences of three rates.",
       "The same sum of squares by Gauss-Newton; `fit.method = \"nelder_mead\"` gives the same numbers.",
       {},
       {},
       fitted_numbers,
       group}};
}

std::vector<Figure> flight_figures() {
  return {{"Fig. 8",
           "Angular velocity about the roll axis",
           "The new parameters follow the telemetry better than the conventional ones; the simulated "
           "amplitude is much "
           "smaller than the measured one.",
           flight_method,
           one("Roll rate, first flight"),
           {},
           rate<0, 2>,
           group},
          {"Fig. 9",
           "Angular velocity about the pitch axis",
           "As Fig. 8.",
           flight_method,
           one("Pitch rate, first flight"),
           {},
           rate<0, 0>,
           group},
          {"Fig. 10",
           "Angular velocity about the yaw axis",
           "As Fig. 8.",
           flight_method,
           one("Yaw rate, first flight"),
           {},
           rate<0, 1>,
           group},
          {"Fig. 11",
           "Contact forces on the snare wires",
           "Wire 1 strikes the shaft first, then wire 2; the shaft is tightened up at 29.2 s.",
           "scenario `data/scenarios/ssrms_htv_capture.toml`. Assumed: a shaft at rest 20 mm off the axis, "
           "where the wires "
           "come in this order. The clock is set so that the last wire is tight at 29.2 s.",
           {{"Force on the shaft", time, {"force", "N"}}},
           {{"wire 1", capture, "pin on snare::wire_1 normal_N", 0, 1.0, "time_s", clock_of_capture},
            {"wire 2", capture, "pin on snare::wire_2 normal_N", 0, 1.0, "time_s", clock_of_capture},
            {"wire 3", capture, "pin on snare::wire_3 normal_N", 0, 1.0, "time_s", clock_of_capture}},
           figure_11},
          {"Fig. 12",
           "Roll rate by the stiffness of the fixture's base",
           "K_GF sets the frequency of the roll; K_wire has little effect, above all in the early phase.",
           "scenario `data/records/flight_scenario.toml`, end effector at rest, fixture held from 29.5 s on; "
           "200 outputs a "
           "second, since the paper's step of 0.05 s is near half a period of the roll.",
           {{"Roll rate by K_GF", time, rates}, {"Roll rate by K_wire", time, rates}},
           {roll("K_GF = 0.5e8 N m/rad", half_K_GF, 0), roll("1e8 N m/rad", flight, 0),
            roll("2e8 N m/rad", double_K_GF, 0), roll("K_wire = 2.8e5 N/m", half_K_wire, 1),
            roll("5.55e5 N/m", flight, 1), roll("11.1e5 N/m", double_K_wire, 1)},
           figure_12},
          {"Fig. 13",
           "Angular velocity about the roll axis, second flight",
           "With the key parameters of the first flight the second one is predicted: events and amplitudes "
           "agree in order.",
           second_method,
           one("Roll rate, second flight"),
           {},
           rate<1, 2>,
           group},
          {"Fig. 14",
           "Angular velocity about the pitch axis, second flight",
           "As Fig. 13.",
           second_method,
           one("Pitch rate, second flight"),
           {},
           rate<1, 0>,
           group},
          {"Fig. 15",
           "Angular velocity about the yaw axis, second flight",
           "As Fig. 13.",
           second_method,
           one("Yaw rate, second flight"),
           {},
           rate<1, 1>,
           group}};
}

std::vector<Lost> lost() {
  return {
      {"Figs. 1 to 4", "photographs and sketches; nothing is computed for them"},
      {"Fig. 7", "flowchart of the optimisation; `snare fit` follows it"},
      {"Table 2, the SSRMS",
       "17.6 m and 1.8 t are printed; the shipped arm follows another published set of link data (1641 kg), "
       "`data/arms/ssrms_like_1800kg.toml` has the printed mass"},
      {"telemetry of both flights", "not public; Figs. 8 to 10 and 13 to 15 use synthetic records"},
      {"fitted K_wire, K_GF and rate", "not printed, so that the fitted numbers cannot be compared"},
      {"amplitude in roll that is too small",
       "the telemetry is missing. What a giving attachment of the arm does to it: "
       "`data/records/flight_attachment.toml`"},
      {"readings of Fig. 6", "drawn only; the rate of Table 4 is compared"},
      {"forces of Fig. 11", "drawn only; the order of the wires is compared"},
      {"l and L of eq. (1), sizes of end effector and fixture, offset of the shaft", "not printed: assumed"}};
}

}  // namespace

const Paper& honda() {
  static const Paper paper{
      "honda",
      "Honda, Oda, Nakanishi, Suzuki: Contact dynamics analysis for HTV capturing by SSRMS, Trans. JSASS "
      "Aerospace Tech. Japan 12, ists29, 2014",
      "Honda et al.", joined({declared_figures(), flight_figures()}), lost()};
  return paper;
}

}  // namespace snare::papers
