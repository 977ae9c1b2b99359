#include "reduction/law_fit.hpp"
#include "reduction/load_unload.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace snare::reduction {
namespace {

const coupling::LawPlace place{0.175, 0.065, 0.1755, 0.01};

std::vector<double> travels(int count, double end) {
  std::vector<double> d;
  for (int i = 0; i <= count; ++i) d.push_back(end * i / count);
  return d;
}

Eigen::VectorXd numbers_of(const std::string& name) {
  std::vector<double> p{2.0e4, 4.0e-4};  // stretched
  if (name == "quadratic") p = {8.0e5, 400.0, 0.2};
  if (name == "quadratic_through_origin") p = {8.0e5, 400.0};
  if (name == "linear") p = {3000.0};
  if (name == "power") p = {2.0e5, 1.8};
  if (name == "tensioned_wire") p = {70.0};
  return Eigen::Map<const Eigen::VectorXd>(p.data(), static_cast<Eigen::Index>(p.size()));
}

// A form fitted to its own curve finds its numbers again. Laws with a kink are not reproduced by the spline
// that carries the curve, but at its knots, where the fit looks.
TEST(LawFit, FindsItsOwnNumbers) {
  for (const coupling::LawFormPointer& form : coupling::law_forms(place)) {
    const Eigen::VectorXd p = numbers_of(form->name());
    const std::vector<double> d = travels(60, 4e-3);
    std::vector<double> force;
    for (const double x : d) force.push_back(form->force(p, x));
    std::vector<std::size_t> at;
    for (std::size_t i = 0; i < d.size(); i += 3) at.push_back(i);
    const FittedLaw law = fit_law(form, numerics::HermiteCurve(d, force), at);
    ASSERT_EQ(law.values.size(), p.size()) << form->name();
    for (Eigen::Index i = 0; i < p.size(); ++i)
      EXPECT_NEAR(law.values[i] / p[i], 1.0, 1e-6) << form->name() << " " << i;
    EXPECT_LT(law.error.largest_force, 1e-8 * law.error.force_range) << form->name();
  }
}

// Central differences over 1e-5 of each number and of the travel: truncation about 1e-9, round-off 1e-11.
TEST(LawFit, DerivativesMatchDifferences) {
  for (const coupling::LawFormPointer& form : coupling::law_forms(place)) {
    const Eigen::VectorXd p = numbers_of(form->name());
    for (const double d : {0.9e-3, 2.2e-3, 3.7e-3}) {
      const Eigen::VectorXd exact = form->by_parameters(p, d);
      for (Eigen::Index i = 0; i < p.size(); ++i) {
        Eigen::VectorXd up = p;
        Eigen::VectorXd down = p;
        const double h = 1e-5 * std::abs(p[i]);
        up[i] += h;
        down[i] -= h;
        const double difference = (form->force(up, d) - form->force(down, d)) / (2.0 * h);
        EXPECT_NEAR(exact[i], difference, 1e-6 * std::abs(difference)) << form->name() << " number " << i;
      }
      const double h = 1e-5 * d;
      const double slope = (form->force(p, d + h) - form->force(p, d - h)) / (2.0 * h);
      EXPECT_NEAR(form->stiffness(p, d), slope, 1e-6 * std::abs(slope)) << form->name();
      const double power = (form->energy(p, d + h) - form->energy(p, d - h)) / (2.0 * h);
      EXPECT_NEAR(form->force(p, d), power, 1e-6 * std::abs(power)) << form->name();
      EXPECT_NEAR(form->with(p)->force(d), form->force(p, d), 1e-13 * std::abs(power)) << form->name();
    }
  }
}

// Honda et al., eq. 1, at mid-span: l = 90, L = 87.5 mm, K = EA/l = 5.55e5 N/m; eq. 2: 60810 N/m. Printed to
// four digits.
TEST(StretchedWire, IsHondasLawAtMidSpan) {
  const double k_wire = 5.55e5;
  const coupling::LawPlace middle{0.175, 0.0875, 0.180, 0.01};
  Eigen::VectorXd p(2);
  p << k_wire * 0.09, 0.0;
  const double h = std::sqrt(0.09 * 0.09 - 0.0875 * 0.0875);
  for (const double x : {1e-3, 10e-3}) {
    const double honda = 2.0 * k_wire * (1.0 - 0.09 / std::sqrt(0.09 * 0.09 + 2.0 * h * x + x * x)) * (h + x);
    EXPECT_NEAR(coupling::stretched_wire_law(middle)->force(p, x), honda, 1e-9 * honda);
  }
  EXPECT_NEAR(coupling::stretched_wire_linearised(middle)->force(p, 1.0), 60810.0, 5.0);
}

// The scatter of fits to noisy curves is what the covariance says: 200 draws, standard deviation to 5 % (one
// in 1/sqrt(400)).
TEST(LawFit, CovarianceIsTheScatterOfNoisyFits) {
  const std::vector<double> d = travels(30, 4e-3);
  std::vector<std::size_t> all(d.size());
  std::iota(all.begin(), all.end(), 0);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.1);
  double sum = 0.0;
  double square = 0.0;
  double claimed = 0.0;
  constexpr int draws = 200;
  for (int k = 0; k < draws; ++k) {
    std::vector<double> force;
    for (const double x : d) force.push_back(8e5 * x * x + 400.0 * x + noise(random));
    const FittedLaw law = fit_law(coupling::quadratic_law(), numerics::HermiteCurve(d, force), all);
    sum += law.values[0];
    square += law.values[0] * law.values[0];
    claimed += law.covariance(0, 0) / draws;
  }
  const double scatter = std::sqrt(square / draws - sum * sum / draws / draws);
  EXPECT_NEAR(scatter / std::sqrt(claimed), 1.0, 0.2);
}

TEST(FittedLaw, RefusesOrFlagsOutsideItsRange) {
  const std::vector<double> d = travels(30, 4e-3);
  std::vector<double> force;
  for (const double x : d) force.push_back(3000.0 * x);
  const FittedLaw law = fit_law(coupling::linear_law(), numerics::HermiteCurve(d, force), {0, 10, 20, 30});
  EXPECT_FALSE(law.at(2e-3, coupling::Outside::refuse).extrapolated);
  EXPECT_EQ(law.at(-1e-3, coupling::Outside::refuse).force, 0.0);
  EXPECT_TRUE(law.at(5e-3, coupling::Outside::extrapolate).extrapolated);
  try {
    static_cast<void>(law.at(5e-3, coupling::Outside::refuse));
    FAIL() << "accepted";
  } catch (const std::domain_error& error) {
    EXPECT_STREQ(error.what(), "travel of 5 mm is outside the range of the law linear, 0 to 4 mm");
  }
}

// Any closed way loses energy or none.
TEST(LoadUnload, NeverGivesEnergy) {
  const std::vector<double> d = travels(40, 4e-3);
  std::vector<double> force;
  for (const double x : d) force.push_back(8e5 * x * x);
  const LoadUnloadLaw law(numerics::HermiteCurve(d, force), 0.7, 4e-4);
  LoadUnloadState state;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> target(0.5e-3, 3.5e-3);
  double work = 0.0;
  double last = law.move(state, 0.0);
  double from = 0.0;
  for (int leg = 0; leg < 40; ++leg) {
    const double to = leg == 39 ? 0.0 : target(random);
    for (int i = 1; i <= 400; ++i) {
      const double x = from + (to - from) * i / 400;
      const double before = state.travel;
      const double now = law.move(state, x);
      work += 0.5 * (now + last) * (x - before);
      last = now;
    }
    from = to;
  }
  EXPECT_GT(work, 0.0);
}

}  // namespace
}  // namespace snare::reduction
