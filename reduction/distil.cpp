#include "reduction/distil.hpp"

#include <utility>

namespace snare::reduction {

namespace {

constexpr int fit_every = 3;  // travels that a fit sees; the others check it
constexpr int stiffness_points = 40;
constexpr int map_slacks = 17;
constexpr int map_travels = 60;

RecordedLaw record(const numerics::HermiteCurve& full, double offset,
                   const std::vector<std::size_t>& fit_at) {
  std::vector<double> force;
  for (const double d : full.knots()) force.push_back(d > offset ? full.value(d - offset) : 0.0);
  const numerics::HermiteCurve recorded(full.knots(), force);
  return {offset, fit_law(coupling::quadratic_law(), recorded, fit_at),
          stiffness_curve(recorded, stiffness_points)};
}

}  // namespace

numerics::SolveReport fit_places(CurveStore& store, std::vector<DistilledPlace>& places,
                                 const SamplingObserver& observer) {
  const WireCase& wire = store.wire();
  std::vector<CurvePlace> wanted;
  for (const double s : wire.law_positions) wanted.push_back({s, wire.nominal_slack()});
  numerics::SolveReport report = store.sample(wanted, observer);
  if (!report.usable()) return report;
  std::vector<std::size_t> fit_at;
  for (std::size_t i = 0; i < store.travel().size(); i += fit_every) fit_at.push_back(i);
  for (const double s : wire.law_positions) {
    const PushedCurve& curve = store.at({store.folded(s), wire.nominal_slack()});
    DistilledPlace place{s, numerics::HermiteCurve(store.travel(), curve.loading), {}, {}, {}, {}, {}, {}};
    const coupling::LawPlace geometry{wire.test.mount.span, s, wire.test.wire.length,
                                      wire.test.wire.bending_stiffness()};
    for (const coupling::LawFormPointer& form : coupling::law_forms(geometry)) {
      FittedLaw law = fit_law(form, place.full, fit_at);
      if (law.values.size() > 0) place.laws.push_back(std::move(law));
    }
    place.stiffness = stiffness_curve(place.full, stiffness_points);
    if (!wire.law_offsets.empty())
      place.recorded = record(place.full, wire.law_offsets[places.size()], fit_at);
    if (!curve.unloading.empty()) {
      const numerics::HermiteCurve back(store.travel(), curve.unloading);
      place.dissipation = dissipation(place.full, back);
      place.load_unload = fit_load_unload(place.full, back);
    }
    places.push_back(std::move(place));
  }
  return report;
}

namespace {

/// Impacts on the full wire at every law position.
numerics::SolveReport distil_impacts(const WireCase& wire, const ImpactSettings& impacts,
                                     std::vector<DistilledPlace>& places, const SamplingObserver& observer) {
  numerics::SolveReport report;
  const std::size_t wanted = places.size() * impacts.speeds.size();
  std::size_t finished = 0;
  for (DistilledPlace& place : places) {
    coupling::PushProblem test = wire.test;
    test.contact_position = place.position;
    for (const double speed : impacts.speeds) {
      place.impacts.push_back(distil_impact(test, impacts, speed, place.full, report));
      if (!report.usable()) {
        report.message = "impact at s = " + std::to_string(1e3 * place.position) + " mm: " + report.message;
        return report;
      }
      if (observer && !observer(++finished, wanted)) {
        return report.end(numerics::Termination::interrupted, "interrupted");
      }
    }
  }
  return report;
}

}  // namespace

Distillation distil(const WireFile& file, const std::filesystem::path& journal,
                    const SamplingObserver& observer, const JournalTrouble& trouble) {
  Distillation result;
  for (const WireCase& wire : file.cases) {
    CurveStore store(wire, file.settings, sampling_travel(wire, file.settings), journal, trouble);
    DistilledCase one;
    one.wire = wire;
    const double span = wire.test.mount.span;
    one.groups = {wire.test.wire.axial_stiffness() * span * span / wire.test.wire.bending_stiffness(),
                  wire.test.pusher.radius / span, wire.test.pusher.friction};
    one.table = build_table(store, file.settings, observer);
    result.report = one.table.report;
    if (result.report.usable()) result.report = fit_places(store, one.places, observer);
    result.solved += store.solved();
    if (!result.report.usable()) return result;
    if (file.impacts) result.report = distil_impacts(wire, *file.impacts, one.places, observer);
    if (!result.report.usable()) return result;
    one.map = map_laws(wire, file.settings, map_slacks, map_travels);
    result.cases.push_back(std::move(one));
  }
  return result;
}

}  // namespace snare::reduction
