#include "validation/elastica_flow.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace snare::validation {
namespace {

const ElasticaLaw kLaw{2e-3, 0.7};
const ElasticaSection kStart{0.1, -0.2, 0.4, -3.0};
constexpr ElasticaForce kForce{-20.0, 35.0};

std::array<double, 4> entries(const ElasticaSection& s) {
  return {s.x, s.y, s.angle, s.moment};
}

TEST(ElasticaFlow, ConservesItsInvariant) {
  // d/dS [M^2/2 + kappa0 M + N + eps N^2/2] = 0, from M' = -(1 + eps N) V and N' = V theta'.
  const auto invariant = [](const ElasticaSection& s) {
    const double tension = section_forces(kForce, s.angle).tension;
    return 0.5 * s.moment * s.moment + kLaw.natural_curvature * s.moment + tension +
           0.5 * kLaw.compliance * tension * tension;
  };
  const double before = invariant(kStart);
  for (const double length : {0.1, 0.5, 2.0}) {
    const ElasticaSection end = elastica_flow(kLaw, kStart, kForce, length).end;
    // Integrator to 1e-14 a piece, growing with the solution's own instability over some seven periods.
    EXPECT_NEAR(invariant(end) / before, 1.0, 1e-11) << length;
  }
}

TEST(ElasticaFlow, MomentBalancesTheEnds) {
  // M' + r' x n = 0 integrated: M + (r - r_start) x n is constant.
  const ElasticaSection end = elastica_flow(kLaw, kStart, kForce, 0.8).end;
  const double lever = (end.x - kStart.x) * kForce.y - (end.y - kStart.y) * kForce.x;
  // As above: the integrator's 1e-14 a piece, grown.
  EXPECT_NEAR(end.moment + lever, kStart.moment, 1e-11);
}

// The integrator's error is 1e-14 a piece; over half a unit of length it grows a hundredfold at most.
TEST(ElasticaFlow, TwoPiecesAreOne) {
  const ElasticaSection whole = elastica_flow(kLaw, kStart, kForce, 0.6).end;
  const ElasticaSection half = elastica_flow(kLaw, kStart, kForce, 0.25).end;
  const ElasticaSection rest = elastica_flow(kLaw, half, kForce, 0.35).end;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(entries(rest)[i], entries(whole)[i], 1e-12);
}

TEST(ElasticaFlow, BackAndForthIsTheIdentity) {
  const ElasticaSection there = elastica_flow(kLaw, kStart, kForce, 0.4).end;
  const ElasticaSection back = elastica_flow(kLaw, there, kForce, -0.4).end;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(entries(back)[i], entries(kStart)[i], 1e-12);
}

TEST(ElasticaFlow, WithoutForceItIsACircle) {
  const ElasticaSection end = elastica_flow({0.0, 0.5}, {0.0, 0.0, 0.0, 1.5}, {0.0, 0.0}, 1.0).end;
  // Some hundred roundings.
  EXPECT_NEAR(end.angle, 2.0, 5e-14);
  EXPECT_NEAR(end.x, std::sin(2.0) / 2.0, 5e-14);
  EXPECT_NEAR(end.y, (1.0 - std::cos(2.0)) / 2.0, 5e-14);
}

TEST(ElasticaFlow, SensitivityMatchesDifferences) {
  const double length = 0.5;
  const ElasticaFlow flow = elastica_flow(kLaw, kStart, kForce, length);
  for (std::size_t k = 0; k < 4; ++k) {
    const double step = 1e-5;
    const auto at = [&](double sign) {
      ElasticaSection start = kStart;
      ElasticaForce force = kForce;
      (k == 0 ? start.angle : k == 1 ? start.moment : k == 2 ? force.x : force.y) += sign * step;
      return entries(elastica_flow(kLaw, start, force, length).end);
    };
    const auto high = at(1.0);
    const auto low = at(-1.0);
    for (std::size_t i = 0; i < 4; ++i) {
      // Central difference: step^2 = 1e-10 times third derivatives of up to 1e3, rounding 1e-14/step.
      EXPECT_NEAR(flow.sensitivity[i][k], (high[i] - low[i]) / (2.0 * step), 1e-6) << i << k;
    }
  }
  const auto longer = entries(elastica_flow(kLaw, kStart, kForce, length + 1e-5).end);
  const auto shorter = entries(elastica_flow(kLaw, kStart, kForce, length - 1e-5).end);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(entries(flow.rate)[i], (longer[i] - shorter[i]) / 2e-5, 1e-6) << i;
  }
}

}  // namespace
}  // namespace snare::validation
