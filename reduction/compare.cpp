#include "reduction/compare.hpp"

#include "coupling/statics/push_solver.hpp"
#include "reduction/error_reason.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace snare::reduction {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int timed_rounds = 7;
constexpr std::size_t timed_evaluations = 20000;
// What the full wire is told: EI, EA, length, span, radius and friction of the pusher, place of the contact.
constexpr int full_wire_parameters = 7;
constexpr double honda_half_wire_stiffness = 5.55e5;  // K_wire [N/m]

/// Seconds of one evaluation: the least of some rounds, each over many.
template <class Force>
double time_of(const Force& force, double end) {
  double least = 1.0;
  volatile double sink = 0.0;
  for (int round = 0; round < timed_rounds; ++round) {
    const auto begin = Clock::now();
    double sum = 0.0;
    for (std::size_t i = 0; i < timed_evaluations; ++i) {
      sum += force(end * static_cast<double>((i * 7919) % timed_evaluations) /
                   static_cast<double>(timed_evaluations));
    }
    sink = sum;
    const std::chrono::duration<double> took = Clock::now() - begin;
    least = std::min(least, took.count() / static_cast<double>(timed_evaluations));
  }
  static_cast<void>(sink);
  return least;
}

void judge(ModelResult& result, const StaticCase& one, const std::vector<double>& full) {
  double sum = 0.0;
  double apart = 0.0;
  std::size_t count = 0;
  std::size_t readings = 0;
  for (std::size_t i = 0; i < one.travel.size(); ++i) {
    if (one.travel[i] > result.range.high) continue;
    const double miss = std::abs(result.force[i] - full[i]);
    result.largest_error = std::max(result.largest_error, miss);
    sum += miss * miss;
    ++count;
    if (one.measured.empty()) continue;
    apart += (result.force[i] - one.measured[i]) * (result.force[i] - one.measured[i]);
    ++readings;
  }
  result.rms_error = count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
  if (readings > 0) result.measured_rms = std::sqrt(apart / static_cast<double>(readings));
}

/// The full wire over the very travels of the case, as the first model; false where it does not reach all.
bool push_full_wire(const StaticCase& one, const DistilSettings& settings, CaseComparison& result) {
  coupling::PushProblem test = one.wire.test;
  test.contact_position = one.wire.law_positions.front();
  for (const double d : one.travel) {
    if (d >= 0.0) test.travel.push_back(d);
  }
  coupling::PushOptions options;
  options.elements = settings.elements;
  const auto begin = Clock::now();
  const coupling::PushCurve curve = settings.extrapolate
                                        ? coupling::solve_push_extrapolated(test, options).curve
                                        : coupling::solve_push(test, options);
  const std::chrono::duration<double> took = Clock::now() - begin;
  result.report = curve.report;
  ModelResult full;
  full.model = "full_wire";
  full.parameters = full_wire_parameters;
  full.range = {0.0, one.wire.travel.high};
  full.seconds = took.count() / static_cast<double>(std::max<std::size_t>(1, test.travel.size()));
  std::size_t at = 0;
  for (const double d : one.travel) {
    if (d < 0.0) {
      full.force.push_back(0.0);
      continue;
    }
    while (at < curve.points.size() && curve.points[at].travel != d)
      ++at;  // the path may pass points in between
    if (at == curve.points.size()) break;
    full.force.push_back(curve.points[at++].force);
  }
  if (full.force.size() < one.travel.size()) {
    if (result.report.usable()) result.report.termination = numerics::Termination::step_too_small;
    return false;
  }
  const auto [low, high] = std::ranges::minmax_element(full.force);
  result.force_range = *high - *low;
  judge(full, one, full.force);
  result.models.push_back(std::move(full));
  return true;
}

/// Adds models to a comparison, each judged against the full wire.
class Comparing {
 public:
  Comparing(const StaticCase& one, CaseComparison& result)
      : one_(one), result_(result), reference_(result.models.front().force) {}

  template <class Force>
  void add(const std::string& name, int parameters, const Interval& range, const Force& force) {
    ModelResult model;
    model.model = name;
    model.parameters = parameters;
    model.range = range;
    for (const double d : one_.travel) model.force.push_back(d < 0.0 ? 0.0 : force(d));
    judge(model, one_, reference_);
    model.why = error_reason(one_.travel, reference_, model.force);
    model.seconds = time_of(force, range.high);
    result_.models.push_back(std::move(model));
  }
  void add_law(const std::string& name, int parameters, const Interval& range,
               const coupling::SpringLaw& law) {
    add(name, parameters, range, [&](double d) { return law.force(d); });
  }

 private:
  const StaticCase& one_;
  CaseComparison& result_;
  std::vector<double> reference_;  // force of the full wire
};

/// The line of a table along the travel, on as many knots as the table's size gives.
numerics::HermiteCurve table_line(const StaticCase& one, const DistilSettings& settings,
                                  const DistilledPlace& place, CurveStore& store) {
  const std::vector<std::size_t> chosen = place_knots(
      store.travel(), {store.at({store.folded(place.position), one.wire.nominal_slack()}).loading},
      static_cast<std::size_t>(settings.points[0]));
  std::vector<double> knots, values, slopes;
  for (const std::size_t i : chosen) {
    knots.push_back(store.travel()[i]);
    values.push_back(place.full.value(knots.back()));
    slopes.push_back(place.full.slope(knots.back()));
  }
  return {knots, values, numerics::monotone_slopes(knots, values, slopes)};
}

}  // namespace

CaseComparison compare_static(const StaticCase& one, const DistilSettings& settings) {
  CaseComparison result;
  result.name = one.name;
  result.travel = one.travel;
  result.measured = one.measured;
  if (!push_full_wire(one, settings, result)) return result;

  CurveStore store(one.wire, settings, sampling_travel(one.wire, settings));
  std::vector<DistilledPlace> places;
  result.report = fit_places(store, places, {});
  if (!result.report.usable()) return result;
  const DistilledPlace& place = places.front();

  Comparing comparing(one, result);
  const numerics::HermiteCurve spline = table_line(one, settings, place, store);
  comparing.add("spline_table", 2 * static_cast<int>(spline.knots().size()), one.wire.travel,
                [&](double d) { return spline.value(d); });
  if (place.load_unload) {
    const LoadUnloadLaw& law = place.load_unload->law;
    LoadUnloadState state;
    comparing.add("load_unload", 2 * static_cast<int>(store.travel().size()) + 2, one.wire.travel,
                  [&](double d) { return law.move(state, d); });
  }
  for (const FittedLaw& law : place.laws) {
    comparing.add_law(law.form->name(), static_cast<int>(law.values.size()), law.range,
                      *law.form->with(law.values));
  }
  // Honda et al., Table 4: the stiffness of half a wire that they started from; it counts from where the wire
  // is taut.
  const coupling::PushProblem& t = one.wire.test;
  const coupling::LawPlace where{t.mount.span, place.position, t.wire.length, t.wire.bending_stiffness()};
  Eigen::VectorXd published(2);
  published << honda_half_wire_stiffness * 0.5 * t.wire.length, 0.0;
  comparing.add_law("stretched_wire_published", 1, one.wire.travel,
                    *coupling::stretched_wire_law(where)->with(published));
  for (const GivenLaw& law : one.given) comparing.add(law.name, law.parameters, law.range, law.force);
  return result;
}

}  // namespace snare::reduction
