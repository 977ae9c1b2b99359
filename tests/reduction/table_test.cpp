#include "coupling/statics/push_solver.hpp"
#include "reduction/table_builder.hpp"
#include "wires.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

namespace snare::reduction {
namespace {

// The bound that a table states holds at random places, solved again by the full wire; a coarse table and a
// coarse mesh.
TEST(TableBuilder, StatedBoundHoldsAtRandomPoints) {
  const WireFile file = small_wire();
  const WireCase& wire = file.cases.front();
  CurveStore store(wire, file.settings, sampling_travel(wire, file.settings));
  const BuiltTable built = build_table(store, file.settings);
  ASSERT_TRUE(built.report.usable()) << built.report.message;
  CurveStore fresh(wire, file.settings, sampling_travel(wire, file.settings));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<CurvePlace> places;
  for (int i = 0; i < 12; ++i) {
    places.push_back({wire.position.low + (wire.position.high - wire.position.low) * u(random),
                      wire.slack.low + (wire.slack.high - wire.slack.low) * u(random)});
  }
  ASSERT_TRUE(fresh.sample(places).usable());
  for (const CurvePlace& place : places) {
    for (std::size_t k = 0; k < fresh.travel().size(); ++k) {
      EXPECT_LE(std::abs(built.loading->force(fresh.travel()[k], place.position, place.slack) -
                         fresh.at(place).loading[k]),
                built.loading_error.bound);
    }
  }
}

// The default table of the fitted wire against the full wire solved again at 1000 places, each from the
// straight wire: 0.5 % of the range of the force, and never beyond the bound that the table states.
TEST(SlowTable, AThousandRandomPoints) {
  WireFile file = small_wire("[ranges]\ntravel_mm = 4.0\n");
  file.settings = {};
  const WireCase& wire = file.cases.front();
  CurveStore store(wire, file.settings, sampling_travel(wire, file.settings));
  const BuiltTable built = build_table(store, file.settings);
  ASSERT_TRUE(built.report.usable()) << built.report.message;
  EXPECT_EQ(built.loading->axes()[0].size(), 20u);
  EXPECT_EQ(built.loading->axes()[1].size(), 9u);
  EXPECT_EQ(built.loading->axes()[2].size(), 5u);
  std::mt19937 random(20);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    coupling::PushProblem test = wire.test;
    test.contact_position = wire.position.low + (wire.position.high - wire.position.low) * u(random);
    const double slack = wire.slack.low + (wire.slack.high - wire.slack.low) * u(random);
    test.wire.length = test.mount.span + slack;
    test.travel = {wire.travel.high * u(random)};
    const coupling::PushCurve curve = coupling::solve_push_extrapolated(test, {}).curve;
    ASSERT_EQ(curve.points.size(), 1u) << curve.report.message;
    worst = std::max(worst, std::abs(built.loading->force(test.travel.front(), test.contact_position, slack) -
                                     curve.points.front().force));
  }
  EXPECT_LE(worst, 0.005 * built.loading_error.force_range);
  EXPECT_LE(worst, built.loading_error.bound);
}

TEST(CurveStore, ATornJournalGivesTheSameCurves) {
  const WireFile file = small_wire();
  const WireCase& wire = file.cases.front();
  const std::filesystem::path journal =
      std::filesystem::temp_directory_path() / "snare_reduction_test.journal";
  std::filesystem::remove(journal);
  const std::vector<CurvePlace> places{{0.05, 4e-4}, {0.06, 5e-4}, {0.08, 6e-4}};
  CurveStore first(wire, file.settings, sampling_travel(wire, file.settings), journal);
  ASSERT_TRUE(first.sample(places).usable());
  std::filesystem::resize_file(journal,
                               std::filesystem::file_size(journal) - 100);  // as if killed while writing
  CurveStore second(wire, file.settings, sampling_travel(wire, file.settings), journal);
  ASSERT_TRUE(second.sample(places).usable());
  EXPECT_EQ(second.solved(), 1u);
  for (const CurvePlace& place : places) EXPECT_EQ(first.at(place).loading, second.at(place).loading);
  std::filesystem::remove(journal);
}

TEST(CurveStore, StopsWhereTheObserverSays) {
  const WireFile file = small_wire();
  CurveStore store(file.cases.front(), file.settings, sampling_travel(file.cases.front(), file.settings));
  const numerics::SolveReport report = store.sample({{0.05, 4e-4}, {0.06, 5e-4}, {0.07, 5e-4}, {0.08, 6e-4}},
                                                    [](std::size_t, std::size_t) { return false; });
  EXPECT_EQ(report.termination, numerics::Termination::interrupted);
  EXPECT_LT(store.curves().size(), 4u);
}

}  // namespace
}  // namespace snare::reduction
