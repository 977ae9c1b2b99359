#include "coupling/statics/push_solver.hpp"
#include "reduction/table_builder.hpp"
#include "wires.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

namespace snare::reduction {
namespace {

// Not-a-knot splines reproduce cubics, to round-off over the smallest cell.
TEST(CubicSpline, ReproducesCubics) {
  const std::vector<double> x{0.0, 0.1, 0.35, 0.5, 1.2, 1.3};
  const auto f = [](double t) { return 1.0 - 2.0 * t + 0.5 * t * t + 3.0 * t * t * t; };
  std::vector<double> v;
  for (const double t : x) v.push_back(f(t));
  const numerics::HermiteCurve curve(x, v);
  for (double t = 0.0; t <= 1.3; t += 0.013) {
    EXPECT_NEAR(curve.value(t), f(t), 1e-12);
    EXPECT_NEAR(curve.slope(t), -2.0 + t + 9.0 * t * t, 1e-11);
    EXPECT_NEAR(curve.integral(t), t - t * t + t * t * t / 6.0 + 0.75 * t * t * t * t, 1e-12);
  }
}

// Fourth order: halving the cells divides the error by 16; 13 leaves room for the ends.
TEST(CubicSpline, ConvergesAtFourthOrder) {
  const auto error = [](int n) {
    std::vector<double> x, v;
    for (int i = 0; i <= n; ++i) {
      x.push_back(static_cast<double>(i) / n);
      v.push_back(std::exp(2.0 * x.back()));
    }
    const numerics::HermiteCurve curve(x, v);
    double worst = 0.0;
    for (double t = 0.0; t <= 1.0; t += 1e-3)
      worst = std::max(worst, std::abs(curve.value(t) - std::exp(2.0 * t)));
    return worst;
  };
  EXPECT_GT(error(10) / error(20), 13.0);
}

// Of a function that is cubic along every axis the table is exact, slopes too; its mirror image answers beyond
// mid-span.
TEST(ForceTable, IsExactForCubicsAndMirrors) {
  const ForceTable::Axes axes{{{0.0, 0.01, 0.02, 0.03}, {0.2, 0.3, 0.35, 0.5}, {0.001, 0.002, 0.004, 0.005}}};
  const auto f = [](double d, double s, double e) {
    return d * (1.0 + 50.0 * d) * (2.0 - s * (1.0 - s)) * (1.0 + 40.0 * e * (1.0 - 30.0 * e));
  };
  const auto fd = [](double d, double s, double e) {
    return (1.0 + 100.0 * d) * (2.0 - s * (1.0 - s)) * (1.0 + 40.0 * e * (1.0 - 30.0 * e));
  };
  std::vector<double> values, slopes;
  for (const double e : axes[2]) {
    for (const double s : axes[1]) {
      for (const double d : axes[0]) {
        values.push_back(f(d, s, e));
        slopes.push_back(fd(d, s, e));
      }
    }
  }
  const double span = 2.0;
  const double ei = 4.0;
  // Values in N at travels in m: the groups divide by the span.
  std::vector<double> slopes_m = slopes;
  for (double& m : slopes_m) m /= span;
  const ForceTable table(axes, values, slopes_m, span, ei, true);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const double d = 0.03 * u(random);
    const double s = 0.2 + 0.3 * u(random);
    const double e = 0.001 + 0.004 * u(random);
    EXPECT_NEAR(table.force(d * span, s * span, e * span), f(d, s, e), 1e-13);
    EXPECT_NEAR(table.force(d * span, (1.0 - s) * span, e * span), f(d, s, e), 1e-13);
    EXPECT_NEAR(table.at(d * span, s * span, e * span, Outside::refuse).stiffness * span, fd(d, s, e), 1e-11);
  }
  EXPECT_TRUE(table.proven_monotone());
  EXPECT_TRUE(table.at(0.04 * span, 0.3 * span, 0.002 * span, Outside::extrapolate).extrapolated);
  EXPECT_THROW(static_cast<void>(table.at(0.01 * span, 0.1 * span, 0.002 * span, Outside::refuse)),
               std::domain_error);
}

// The bound that a table states holds at random places, solved anew by the full wire; a coarse table and a coarse mesh.
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

// The default table of the traced wire against the full wire solved anew at 1000 places, each from the
// straight wire: 0.5 % of the
// range of the force, and never beyond the bound that the table states.
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
