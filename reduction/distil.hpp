#pragma once

#include "reduction/impact_damping.hpp"
#include "reduction/law_fit.hpp"
#include "reduction/law_map.hpp"
#include "reduction/load_unload.hpp"
#include "reduction/table_builder.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace snare::reduction {

/// What a machine would have recorded whose displacement is not zero at first touch: no force before it.
struct RecordedLaw {
  double offset = 0.0;  ///< displacement at first touch [m]
  FittedLaw quadratic;  ///< over the record from 0 to the end of the travel: as fits of records are published
  StiffnessCurve stiffness;  ///< F over the recorded displacement
};

/// The simple laws at one position, at the nominal slack.
struct DistilledPlace {
  double position = 0.0;        ///< [m]
  numerics::HermiteCurve full;  ///< the full wire, loading
  std::vector<FittedLaw> laws;
  StiffnessCurve stiffness;
  std::optional<RecordedLaw> recorded;     ///< where an offset is given
  std::optional<Dissipation> dissipation;  ///< where something dissipates
  std::optional<LoadUnloadFit> load_unload;
  std::vector<ImpactDamping> impacts;  ///< one a speed, where impacts are asked
};

/// Dimensionless groups of a case that its table holds for.
struct WireGroups {
  double axial = 0.0;     ///< EA L^2/EI
  double radius = 0.0;    ///< R/L
  double friction = 0.0;  ///< mu
};

/// One wire with everything distilled from it.
struct DistilledCase {
  WireCase wire;
  WireGroups groups;
  BuiltTable table;
  std::vector<DistilledPlace> places;
  LawMap map;
};

/// What came of a wire file.
struct Distillation {
  std::vector<DistilledCase> cases;  ///< those that were finished
  std::size_t solved = 0;            ///< curves computed in this run, those of the journal not counted
  numerics::SolveReport report;      ///< not usable: the last case is missing
};

/// Distils every case of a wire file. journal: where finished curves are kept until the end; none when empty.
/// trouble: see CurveStore; once a case at most.
[[nodiscard]] Distillation distil(const WireFile& file, const std::filesystem::path& journal = {},
                                  const SamplingObserver& observer = {}, const JournalTrouble& trouble = {});

/// The laws at some positions from curves of the nominal slack; they are sampled where they are not known.
[[nodiscard]] numerics::SolveReport fit_places(CurveStore& store, std::vector<DistilledPlace>& places,
                                               const SamplingObserver& observer);

}  // namespace snare::reduction
