#include "numerics/ida.hpp"

#include "tests/support/derivatives.hpp"
#include "tests/support/sparse_product.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

namespace snare::numerics {
namespace {

/// A mass on a spring with a stop: x' = v, v' = -omega^2 x, and the algebraic energy e = (v^2 + omega^2
/// x^2)/2.
class Oscillator final : public DaePart {
 public:
  explicit Oscillator(double omega) : omega_(omega) {}
  void declare(DaeLayout& layout) override {
    first_ = layout.add({"oscillator", {"position", "velocity"}, 2, DaeKind::differential, 1e-9, 0});
    layout.add({"oscillator energy", {}, 1, DaeKind::algebraic, 1e-9, 0});
  }
  void sparsity(std::vector<std::pair<int, int>>& entries) const override {
    for (const auto& [i, j] : {std::pair{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}}) {
      entries.emplace_back(first_ + i, first_ + j);
    }
  }
  void rates(std::vector<std::pair<int, int>>& pairs) const override {
    if (rate_follows) pairs.emplace_back(first_, first_ + 1);
  }
  void attach_pattern(const SparseMatrix& pattern) override {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) slot_[i][j] = pattern.slot(first_ + i, first_ + j);
    }
  }
  void residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override {
    const double x = at.y[first_];
    const double v = at.y[first_ + 1];
    if (at.time > fails_after) rows[first_ + 1] = std::nan("");
    if (throws) throw std::runtime_error("as asked");
    rows[first_] += at.rate[first_] - v;
    rows[first_ + 1] += at.rate[first_ + 1] + omega_ * omega_ * x;
    rows[first_ + 2] += at.y[first_ + 2] - 0.5 * (v * v + omega_ * omega_ * x * x);
  }
  void jacobian(const DaePoint& at, double c, std::vector<double>& values) override {
    const auto add = [&](int i, int j, double value) {
      values[static_cast<std::size_t>(slot_[i][j])] += value;
    };
    add(0, 0, c);
    add(0, 1, -1.0);
    add(1, 0, omega_ * omega_);
    add(1, 1, c);
    add(2, 0, -omega_ * omega_ * at.y[first_]);
    add(2, 1, -at.y[first_ + 1]);
    add(2, 2, 1.0);
  }
  [[nodiscard]] int event_count() const override { return 1; }
  void events(const DaePoint& at, std::span<double> values) override {
    const double x = at.y[first_];
    values[0] = std::abs(x) < zero_within ? 0.0 : x;
  }
  bool outgrows_pattern(const DaePoint&) override { return changes_pattern; }

  double fails_after = 1e300;
  double zero_within = 0.0;
  bool throws = false;
  bool changes_pattern = false;
  bool rate_follows = false;

 private:
  double omega_;
  int first_ = 0;
  int slot_[3][3] = {};
};

Eigen::Vector3d displaced() {
  return {1.0, 0.0, 0.5 * 4.0};
}
const Eigen::Vector3d displaced_rate(0.0, -4.0, 0.0);

IdaOptions tight() {
  IdaOptions options;
  options.relative_tolerance = 1e-10;
  options.cautious_start = true;
  return options;
}

TEST(Ida, FollowsAnOscillationAndItsAlgebraicEnergy) {
  Oscillator part(2.0);
  DaeSystem system({&part});
  Ida ida(system, tight());
  ida.start(0.0, displaced(), displaced_rate);
  const IdaReport report = integrate(ida, 3.0);
  ASSERT_TRUE(report.usable()) << report.message;
  EXPECT_EQ(ida.time(), 3.0);
  // A local error of 1e-10 a step grows over six radians by some tens of steps' worth.
  EXPECT_NEAR(ida.y()[0], std::cos(6.0), 3e-8);
  EXPECT_NEAR(ida.y()[2], 2.0, 1e-7);
  EXPECT_GT(ida.statistics().steps, 100);
  EXPECT_EQ(ida.statistics().analyses, 1);
  EXPECT_EQ(ida.statistics().restarts, 1);
  EXPECT_EQ(ida.statistics().factorizations, ida.statistics().jacobians);
}

// The rate is eliminated and follows its place.
TEST(Ida, RatesFollowTheirPlaces) {
  Oscillator part(2.0);
  part.rate_follows = true;
  DaeSystem system({&part});
  IdaOptions options = tight();
  options.newton_test = NewtonTest::every_unknown;
  options.newton_share = 1e-3;  // as in coupled motions
  Ida ida(system, options);
  ida.start(0.0, displaced(), displaced_rate);
  const IdaReport report = integrate(ida, 3.0);
  ASSERT_TRUE(report.usable()) << report.message;
  EXPECT_NEAR(ida.y()[0], std::cos(6.0), 3e-8);  // as above
  EXPECT_NEAR(ida.y()[2], 2.0, 1e-7);
  // Initial values have any rates to begin with.
  const IdaReport start =
      ida.start_consistently(0.0, Eigen::Vector3d(1.0, 0.5, 0.0), Eigen::Vector3d::Zero(), 0.1);
  ASSERT_TRUE(start.usable()) << start.message;
  EXPECT_NEAR(ida.rate()[0], 0.5, 1e-9);
  EXPECT_NEAR(ida.rate()[1], -4.0, 1e-9);
}

TEST(Ida, AFailureWithTheTestOfEveryUnknownEnds) {
  Oscillator part(2.0);
  part.fails_after = 1.0;
  DaeSystem system({&part});
  IdaOptions options = tight();
  options.newton_test = NewtonTest::every_unknown;
  Ida ida(system, options);
  ida.start(0.0, displaced(), displaced_rate);
  const IdaReport report = integrate(ida, 3.0);
  EXPECT_FALSE(report.usable());
  EXPECT_LE(report.time, 1.0);
  EXPECT_THAT(report.message, testing::HasSubstr("oscillator, velocity"));
}

TEST(Ida, FindsConsistentAlgebraicUnknownsAndRates) {
  Oscillator part(2.0);
  DaeSystem system({&part});
  Ida ida(system, tight());
  const IdaReport report =
      ida.start_consistently(0.0, Eigen::Vector3d(1.0, 0.5, 0.0), Eigen::Vector3d::Zero(), 0.1);
  ASSERT_TRUE(report.usable()) << report.message;
  // The Newton iteration for initial values ends at a hundredth of the tolerance of 1e-10.
  EXPECT_NEAR(ida.y()[2], 0.125 + 2.0, 1e-9);
  EXPECT_NEAR(ida.rate()[0], 0.5, 1e-9);
  EXPECT_NEAR(ida.rate()[1], -4.0, 1e-9);
}

/// Steps until an event, the limit or a failure.
IdaAdvance advance_to_something(Ida& ida, double limit) {
  IdaAdvance result = IdaAdvance::stepped;
  while (result == IdaAdvance::stepped) result = ida.advance(limit);
  return result;
}

TEST(Ida, StopsWhereAnEventFunctionIsZero) {
  Oscillator part(2.0);
  DaeSystem system({&part});
  Ida ida(system, tight());
  ida.start(0.0, displaced(), displaced_rate);
  ASSERT_EQ(advance_to_something(ida, 10.0), IdaAdvance::event);
  EXPECT_THAT(ida.events_found(), testing::ElementsAre(-1));
  EXPECT_NEAR(ida.time(), 0.25 * M_PI, 1e-8);  // of the integration, see above
  // Going on past the event with the velocity reversed: a bounce, and the way back.
  Eigen::VectorXd y = ida.y();
  Eigen::VectorXd rate = ida.rate();
  y[0] = 0.0;  // exactly: beyond zero by round-off it would cross it again
  y[1] = -y[1];
  rate[0] = y[1];
  ida.start(ida.time(), y, rate);
  EXPECT_EQ(advance_to_something(ida, 1.5), IdaAdvance::reached_limit);
  EXPECT_NEAR(ida.y()[0], std::abs(std::cos(3.0)), 1e-7);
  EXPECT_EQ(ida.statistics().restarts, 2);
}

// As the gap of a touch may be, to round-off.
TEST(Ida, GoesOnWhereAnEventFunctionStaysZero) {
  Oscillator part(2.0);
  part.zero_within = 1e-13;
  DaeSystem system({&part});
  Ida ida(system, tight());
  ida.start(0.0, displaced(), displaced_rate);
  ASSERT_EQ(advance_to_something(ida, 10.0), IdaAdvance::event);
  EXPECT_EQ(advance_to_something(ida, 1.5), IdaAdvance::reached_limit);
  EXPECT_NEAR(ida.y()[0], std::cos(3.0), 1e-7);
}

TEST(Ida, ObserverStopsTheRun) {
  Oscillator part(2.0);
  DaeSystem system({&part});
  Ida ida(system, tight());
  ida.start(0.0, displaced(), displaced_rate);
  const IdaReport report = integrate(ida, 3.0, [](const Ida& at) { return at.time() > 1.0; });
  EXPECT_EQ(report.termination, Termination::interrupted);
  EXPECT_GT(ida.time(), 1.0);
  EXPECT_LT(ida.time(), 1.2);
}

TEST(Ida, FailureNamesTimeStepAndUnknown) {
  Oscillator part(2.0);
  part.fails_after = 1.0;
  DaeSystem system({&part});
  Ida ida(system, tight());
  ida.start(0.0, displaced(), displaced_rate);
  const IdaReport report = integrate(ida, 3.0);
  EXPECT_FALSE(report.usable());
  EXPECT_LE(report.time, 1.0);
  EXPECT_GT(report.time, 0.9);
  EXPECT_NEAR(ida.y()[0], std::cos(2.0 * ida.time()), 1e-7);  // the last accepted state is kept
  ASSERT_FALSE(report.worst_unknowns.empty());
  EXPECT_EQ(report.worst_unknowns.front(), "oscillator, velocity");
  EXPECT_THAT(report.message, testing::HasSubstr("oscillator, velocity"));
}

TEST(Ida, ExceptionsOfAPartPassThrough) {
  Oscillator part(2.0);
  DaeSystem system({&part});
  Ida ida(system, tight());
  ida.start(0.0, displaced(), displaced_rate);
  part.throws = true;
  EXPECT_THROW((void)integrate(ida, 1.0), std::runtime_error);
}

TEST(Ida, AnalysesThePatternAgainOnlyWhenAPartAsks) {
  Oscillator part(2.0);
  part.changes_pattern = true;
  DaeSystem system({&part});
  Ida ida(system, tight());
  ida.start(0.0, displaced(), displaced_rate);
  ASSERT_TRUE(integrate(ida, 0.5).usable());
  EXPECT_GT(ida.statistics().analyses, 1);
  EXPECT_NEAR(ida.y()[0], std::cos(1.0), 1e-8);
}

// The integral of v by the formula that makes x' = v: it is x - x(0), however large the error of both.
TEST(Ida, IntegralsAgreeWithWhatIsLinear) {
  Oscillator part(2.0);
  DaeSystem system({&part});
  IdaOptions loose;
  loose.relative_tolerance = 1e-3;
  loose.newton_test = NewtonTest::every_unknown;
  loose.newton_share = 1e-6;
  loose.cautious_start = true;  // steps in which the event comes late: it is looked back from there
  Ida ida(system, loose, {2, [](const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rates) {
                            rates << at.y[1], at.y[0] * at.y[0];
                          }});
  ida.start(0.0, displaced(), displaced_rate);
  double worst = 0.0;
  double within = 0.0;
  const IdaReport report = integrate(ida, 3.0, [&](const Ida& at) {
    worst = std::max(worst, std::abs(at.integrals()[0] - (at.y()[0] - 1.0)));
    const double t = at.time() - 0.4 * at.last_step();
    within = std::max(within, std::abs(at.interpolate_integrals(t)[0] - (at.interpolate(t)[0] - 1.0)));
    if (at.events_found()[0] == 0) {
      EXPECT_NEAR(at.integral_rates()[0], at.y()[1], 1e-12);
      EXPECT_NEAR(at.integral_rates()[1], at.y()[0] * at.y()[0], 1e-12);
    }
    return false;
  });
  ASSERT_TRUE(report.usable()) << report.message;
  EXPECT_GT(std::abs(ida.y()[0] - std::cos(6.0)), 1e-6);  // loose
  EXPECT_LT(worst, 1e-8);                                 // Newton's method leaves 1e-9 at a step
  EXPECT_LT(within, 1e-8);
  EXPECT_NEAR(ida.integrals()[1], 1.5 + std::sin(12.0) / 8.0, 1e-2);
  // A start continues from where they are.
  const Eigen::VectorXd so_far = ida.integrals();
  ida.start(ida.time(), ida.y(), ida.rate());
  EXPECT_EQ(ida.integrals(), so_far);
  ASSERT_TRUE(integrate(ida, 4.0).usable());
  EXPECT_NEAR(ida.integrals()[0], ida.y()[0] - 1.0, 1e-8);
}

// A single unknown among many keeps its own tolerance: blocks count alike.
TEST(Ida, ASmallBlockIsNotLostAmongLargeOnes) {
  std::vector<std::unique_ptr<Oscillator>> quiet;
  std::vector<DaePart*> parts;
  Oscillator part(2.0);
  parts.push_back(&part);
  DaeSystem alone(parts);
  for (int k = 0; k < 100; ++k) {
    quiet.push_back(std::make_unique<Oscillator>(1e-3));
    parts.push_back(quiet.back().get());
  }
  DaeSystem many(parts);
  const auto error = [](DaeSystem& system) {
    IdaOptions options;
    options.relative_tolerance = 1e-6;
    Ida ida(system, options);
    Eigen::VectorXd y = Eigen::VectorXd::Zero(system.size());
    Eigen::VectorXd rate = y;
    y.head<3>() = displaced();
    rate.head<3>() = displaced_rate;
    ida.start(0.0, y, rate);
    EXPECT_TRUE(integrate(ida, 3.0).usable());
    return std::abs(ida.y()[0] - std::cos(6.0));
  };
  // One of 101 blocks: a tenth of the weight it has alone, and so a few times its error.
  EXPECT_LT(error(many), 30.0 * error(alone));
  EXPECT_LT(error(many), 1e-3);
}

TEST(Dae, JacobianOfAPartMatchesDifferences) {
  Oscillator part(2.0);
  DaeSystem system({&part});
  constexpr double c = 7.0;
  const Eigen::Vector3d y(0.3, 0.7, -0.2);
  const Eigen::Vector3d rate(0.1, 0.2, 0.0);
  const SparseMatrix& sparse = system.jacobian({0.0, y, rate}, c);
  Eigen::MatrixXd dense(3, 3);
  for (int j = 0; j < 3; ++j) dense.col(j) = sparse * Eigen::Vector3d::Unit(j);
  // Along y + s, y' + c s: the derivative is dF/dy + c dF/dy'.
  const auto f = [&](const Eigen::VectorXd& s) {
    Eigen::VectorXd rows(3);
    const Eigen::VectorXd moved = y + s;
    const Eigen::VectorXd moved_rate = rate + c * s;
    system.residual({0.0, moved, moved_rate}, rows);
    return rows;
  };
  const test::DerivativeError error = test::compare_jacobian(f, Eigen::Vector3d::Zero(), dense);
  EXPECT_LT(error.relative, 1e-10) << error.worst;  // round-off of the differences
}

}  // namespace
}  // namespace snare::numerics
