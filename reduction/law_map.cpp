#include "reduction/law_map.hpp"

#include "base/parallel.hpp"
#include "coupling/contact/law_form.hpp"
#include "coupling/contact/tensioned_wire.hpp"
#include "coupling/statics/push_solver.hpp"

#include <algorithm>
#include <cmath>

namespace snare::reduction {

namespace {

constexpr double pretension_strain = 1e-3;
// of the travel asked for: the simple laws come near where the wire is well taut
constexpr double reach = 3.0;

LawMapRow row_at(coupling::PushProblem test, double slack, const std::vector<double>& travel,
                 const DistilSettings& settings) {
  LawMapRow row;
  row.slack = slack;
  test.wire.length = test.mount.span + slack;
  test.travel = travel;
  coupling::PushOptions options;
  options.elements = settings.elements;
  const coupling::PushCurve curve = coupling::solve_push_extrapolated(test, options).curve;
  row.natural_height = curve.natural_height;
  for (const coupling::PushPoint& p : curve.points) {
    if (row.full.size() < travel.size() && p.travel == travel[row.full.size()]) row.full.push_back(p.force);
  }
  const double ea = test.wire.axial_stiffness();
  const coupling::LawPlace place{test.mount.span, test.contact_position, test.wire.length,
                                 test.wire.bending_stiffness()};
  const coupling::LawFormPointer stretched = coupling::stretched_wire_law(place);
  // The wire stands off by its natural height; it is taut at the height of its two straight pieces.
  const double taut = 0.5 * std::sqrt(std::max(0.0, place.length * place.length - place.span * place.span));
  Eigen::VectorXd numbers(2);
  numbers << ea, taut - row.natural_height;
  const double tension = std::max(0.0, -slack / place.length * ea);
  const double k =
      coupling::tensioned_stiffness(place.bending_stiffness, tension, place.span, place.position).value;
  for (const double d : travel) {
    row.stretched.push_back(stretched->force(numbers, d));
    row.tensioned.push_back(k * d);
  }
  return row;
}

}  // namespace

std::optional<Interval> LawMap::within(const LawMapRow& row, const std::vector<double> LawMapRow::*law,
                                       double share) const {
  std::optional<Interval> best;
  std::size_t longest = 0;
  std::size_t run = 0;
  for (std::size_t i = 0; i < row.full.size(); ++i) {
    run = std::abs((row.*law)[i] - row.full[i]) <= share * std::abs(row.full[i]) ? run + 1 : 0;
    if (run <= longest) continue;
    longest = run;
    best = Interval{travel[i + 1 - run], travel[i]};
  }
  return best;
}

LawMap map_laws(const WireCase& wire, const DistilSettings& settings, int slacks, int travels) {
  LawMap map;
  coupling::PushProblem test = wire.test;
  test.contact_position = map.position = 0.5 * test.mount.span;
  test.pusher.friction = 0.0;
  test.wire.strand_friction.reset();
  test.wire.yielding.reset();
  test.mount.slip_tension.reset();
  for (int i = 1; i <= travels; ++i)
    map.travel.push_back(reach * wire.travel.high * i * i / (travels * travels));
  const double low = -pretension_strain * test.mount.span;
  const double high = std::max(wire.slack.high, -low);
  map.rows.resize(static_cast<std::size_t>(slacks));
  base::parallel_for(map.rows.size(), [&](std::size_t i) {
    map.rows[i] = row_at(test, low + (high - low) * static_cast<int>(i) / (slacks - 1), map.travel, settings);
  });
  return map;
}

}  // namespace snare::reduction
