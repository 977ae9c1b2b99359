// Where Newton's method begins: a heavy body meets a light mass on a spring through a stiff contact.

#include "numerics/ida.hpp"
#include "tests/support/derivatives.hpp"
#include "tests/support/sparse_product.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace snare::numerics {
namespace {

constexpr double body = 8.9, light = 6e-5, speed = 0.1, gap = 1e-5;  // [kg], [kg], [m/s], [m]
constexpr double spring = 1e5;                                       // [N/m]

/// m_1 v_1' = -F, m_2 v_2' = F - k x_2, F = c d^(3/2) (1 + a d') of the depth d = x_1 - x_2 - gap.
class Impact final : public DaePart {
 public:
  enum class Start { predicted, at_touch, refuses, throws };
  explicit Impact(Start start) : start_(start) {}
  void declare(DaeLayout& layout) override {
    layout.add({"position", {}, 2, DaeKind::differential, 1e-8, 0, false});
    layout.add({"velocity", {}, 2, DaeKind::differential, 1e-5, 0});
  }
  void sparsity(std::vector<std::pair<int, int>>& entries) const override {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) entries.emplace_back(i, j);
    }
  }
  void attach_pattern(const SparseMatrix& pattern) override { pattern_ = &pattern; }
  void residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override {
    const double force = load(at.y);
    rows[0] += at.rate[0] - at.y[2];
    rows[1] += at.rate[1] - at.y[3];
    rows[2] += body * at.rate[2] + force;
    rows[3] += light * at.rate[3] - force + spring * at.y[1];
  }
  void jacobian(const DaePoint& at, double c, std::vector<double>& values) override {
    const auto add = [&](int i, int j, double value) {
      values[static_cast<std::size_t>(pattern_->slot(i, j))] += value;
    };
    const double d = depth(at.y), rate = 1.0 + damping * (at.y[2] - at.y[3]);
    const bool pressed = d > 0.0 && rate > 0.0;
    const double by_depth = pressed ? 1.5 * stiffness * std::sqrt(d) * rate : 0.0;
    const double by_rate = pressed ? stiffness * std::pow(d, 1.5) * damping : 0.0;
    for (int i = 0; i < 2; ++i) {
      add(i, i, c);
      add(i, 2 + i, -1.0);
      const double sign = i == 0 ? 1.0 : -1.0;
      add(2 + i, 0, sign * by_depth);
      add(2 + i, 1, -sign * by_depth);
      add(2 + i, 2, sign * by_rate);
      add(2 + i, 3, -sign * by_rate);
    }
    add(2, 2, body * c);
    add(3, 3, light * c);
    add(3, 1, spring);
  }
  IterationStart iteration_start(const VectorView& from, const VectorView& to) override {
    constexpr double begun = 1e-9;
    if (start_ == Start::throws) throw std::runtime_error("as asked");
    if (start_ == Start::predicted || depth(to) <= begun) return {};
    if (start_ == Start::refuses) return {0.0, true};
    if (load(from) > 0.0) return {load(to) > 8.0 * load(from) || load(to) < load(from) / 8.0 ? 0.0 : 1.0};
    return {(begun - depth(from)) / (depth(to) - depth(from))};
  }
  static double depth(const VectorView& y) { return y[0] - y[1] - gap; }

 private:
  static constexpr double stiffness = 7e11, damping = 1000.0;  // [N/m^(3/2)], [s/m]
  static double load(const VectorView& y) {
    const double rate = 1.0 + damping * (y[2] - y[3]);
    return depth(y) > 0.0 && rate > 0.0 ? stiffness * std::pow(depth(y), 1.5) * rate : 0.0;
  }
  Start start_;
  const SparseMatrix* pattern_ = nullptr;
};

IdaOptions coupled() {
  IdaOptions options;
  options.newton_test = NewtonTest::every_unknown;
  options.newton_share = 2e-4;
  options.max_order = 2;
  options.renewals = 4;
  return options;
}

void start(Ida& ida) {
  ida.start(0.0, Eigen::Vector4d(0.0, 0.0, speed, 0.0), Eigen::Vector4d(speed, 0.0, 0.0, 0.0));
}

// Behind the touch x_1 - gap = v/omega sin(omega t), but for what the light mass takes, 1e-5 of it.
TEST(IterationStart, DoesNotChangeTheMotion) {
  std::vector<Eigen::VectorXd> ends;
  for (const Impact::Start where : {Impact::Start::predicted, Impact::Start::at_touch}) {
    Impact part(where);
    DaeSystem system({&part});
    Ida ida(system, coupled());
    start(ida);
    const IdaReport report = integrate(ida, 0.02);
    ASSERT_TRUE(report.usable()) << report.message;
    const double omega = std::sqrt(spring / (body + light)), phase = omega * (0.02 - gap / speed);
    EXPECT_NEAR(ida.y()[0] - gap, speed / omega * std::sin(phase), 1e-6);
    EXPECT_NEAR(ida.y()[2], speed * std::cos(phase), 1e-3 * speed);
    ends.emplace_back(ida.y());
  }
  EXPECT_LT((ends[0] - ends[1]).lpNorm<Eigen::Infinity>(), 1e-6 * speed);
}

TEST(IterationStart, OutOfReachMakesTheStepShorter) {
  Impact part(Impact::Start::refuses);
  DaeSystem system({&part});
  Ida ida(system, coupled());
  start(ida);
  const IdaReport report = integrate(ida, 0.02);
  EXPECT_FALSE(report.usable());  // no step may go behind the touch
  EXPECT_LE(Impact::depth(ida.y()), 1e-9);
  EXPECT_NEAR(ida.time(), gap / speed, 1e-6);
}

TEST(IterationStart, ExceptionsPassThrough) {
  Impact part(Impact::Start::throws);
  DaeSystem system({&part});
  Ida ida(system, coupled());
  start(ida);
  EXPECT_THROW((void)integrate(ida, 0.02), std::runtime_error);
}

TEST(IterationStart, TheJacobianOfTheImpactMatchesDifferences) {
  Impact part(Impact::Start::predicted);
  DaeSystem system({&part});
  const Eigen::Vector4d y(gap + 2e-7, 1e-7, 0.1, 0.0999), rate(0.1, 0.1, -1.0, 50.0);
  constexpr double c = 1e4;
  const SparseMatrix& sparse = system.jacobian({0.0, y, rate}, c);
  Eigen::MatrixXd dense(4, 4);
  for (int j = 0; j < 4; ++j) dense.col(j) = sparse * Eigen::Vector4d::Unit(j);
  const auto f = [&](const Eigen::VectorXd& s) {
    Eigen::VectorXd rows(4);
    const Eigen::VectorXd moved = y + s, moved_rate = rate + c * s;
    system.residual({0.0, moved, moved_rate}, rows);
    return rows;
  };
  const test::DerivativeError error = test::compare_jacobian(f, Eigen::Vector4d::Zero(), dense, 1e-7);
  EXPECT_LT(error.relative, 1e-7) << error.worst;  // round-off of the differences
}

}  // namespace
}  // namespace snare::numerics
