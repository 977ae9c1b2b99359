#include "wire/section_law.hpp"

#include "tests/support/random_rods.hpp"
#include "tests/support/rod_derivatives.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace snare::wire {
namespace {

constexpr Controls kControls{0.0, 0.45, 1.05};

TEST(SectionLaw, OneSliderIsTheBilinearLoopOfMasing) {
  const std::vector<SliderElement> strand{{3.0, 0.2}};
  double slipped = 0.0;
  const auto at = [&](double strain) {
    const SectionResponse r = respond(1.0, strand, strain, &slipped);
    slide(strand, strain, &slipped);
    return r.resultant;
  };
  EXPECT_DOUBLE_EQ(at(0.1), 0.4);          // both springs
  EXPECT_DOUBLE_EQ(at(0.5), 0.5 + 0.6);    // slipped at 0.2
  EXPECT_DOUBLE_EQ(at(0.4), 0.4 + 0.3);    // sticks again on the way back
  EXPECT_DOUBLE_EQ(at(0.0), -0.6);         // twice the slip strain further it slides the other way
  EXPECT_NEAR(at(0.5), 0.5 + 0.6, 1e-15);  // the loop closes
}

// The stored and dissipated energy is the work of the resultant along a monotone path.
TEST(SectionLaw, EnergyIsTheWork) {
  const std::vector<SliderElement> sliders{{3.0, 0.2}, {1.0, 0.5}};
  const double h = 1e-6;
  for (const double strain : {0.1, 0.3, 0.7, -0.45}) {
    const double up = respond(1.0, sliders, strain + h, nullptr).energy;
    const double down = respond(1.0, sliders, strain - h, nullptr).energy;
    EXPECT_NEAR((up - down) / (2.0 * h), respond(1.0, sliders, strain, nullptr).resultant, 1e-9);
  }
}

// Bending moment of a round elastic-perfectly plastic section, with eta = y_yield/r < 1 (any text on
// plasticity):
//   M/M_e = (2/pi) [ (5 - 2 eta^2) sqrt(1 - eta^2) / 3 + arcsin(eta)/eta ],
//   M_e = E I 2 yield strain / d; 16/(3 pi) M_e at last.
TEST(SectionLaw, YieldingSectionFollowsTheRoundBar) {
  const double ei = 2.0, diameter = 1.5e-3, yield = 3e-3, hardening = 1e-6;
  const std::vector<SliderElement> fibres = yielding_section(ei, diameter, yield, hardening);
  const double first = 2.0 * yield / diameter;
  EXPECT_NEAR(respond(hardening * ei, fibres, 0.9 * first, nullptr).resultant, 0.9 * first * ei,
              1e-9 * first * ei);
  for (const double ratio : {1.2, 1.5, 2.0, 4.0, 20.0}) {
    const double eta = 1.0 / ratio;
    const double exact = 2.0 / std::numbers::pi *
                         ((5.0 - 2.0 * eta * eta) * std::sqrt(1.0 - eta * eta) / 3.0 + std::asin(eta) / eta);
    // Eight pairs of fibres.
    EXPECT_NEAR(respond(hardening * ei, fibres, ratio * first, nullptr).resultant, exact * first * ei,
                1.5e-2 * first * ei)
        << ratio;
  }
}

TEST(SectionLaw, RodWithSlidersHasExactDerivatives) {
  std::mt19937 random(11);
  PlanarRodProperties p = test::planar_properties();
  p.left.kind = PlanarEnd::Kind::clamp;
  p.bending_sliders = {{0.7 * p.bending_stiffness, 0.3}, {0.2 * p.bending_stiffness, 40.0}};
  p.axial_sliders = {{0.5 * p.axial_stiffness, 0.01}};
  const PlanarRod rod(MaterialMesh(4, 6, 0.8), p);
  PlanarState state = test::random_state(rod, kControls, random, 0.4);
  const SectionMemory memory = rod.remembered(test::random_state(rod, kControls, random, 0.2));
  state.memory = &memory;
  const test::RodDerivativeErrors errors = test::check_rod_derivatives(rod, state);
  // As for the elastic rod; away from kinks, which a random state is.
  EXPECT_LT(errors.gradient.relative, 1e-9) << errors.gradient.worst;
  EXPECT_LT(errors.hessian.relative, 1e-9) << errors.hessian.worst;
  EXPECT_LT(errors.control_columns.relative, 1e-9) << errors.control_columns.worst;
  EXPECT_LT(errors.control_gradient.relative, 1e-9) << errors.control_gradient.worst;
  EXPECT_LT(errors.control_hessian.relative, 1e-9) << errors.control_hessian.worst;
}

TEST(SectionLaw, ProfileOfOneIsTheUniformRod) {
  std::mt19937 random(5);
  PlanarRodProperties p = test::planar_properties();
  const PlanarRod uniform(MaterialMesh(4, 6, 0.8), p);
  p.bending_profile = {1.0, 1.0, 1.0};
  const PlanarRod same(MaterialMesh(4, 6, 0.8), p);
  p.bending_profile = {1.0, 2.0};
  const PlanarRod stiffer(MaterialMesh(4, 6, 0.8), p);
  const PlanarState state = test::random_state(uniform, kControls, random, 0.4);
  EXPECT_DOUBLE_EQ(same.energy(state), uniform.energy(state));
  EXPECT_GT(stiffer.energy(state), uniform.energy(state));
}

TEST(SectionLaw, MemoryStaysWithTheMaterial) {
  const MaterialMesh mesh(8, 8, 0.0);
  const Controls before{0.0, 0.5, 1.0};
  const Controls after{-0.1, 0.52, 1.0};
  std::vector<double> values;
  for (int i = 0; i < mesh.vertices(); ++i) values.push_back(3.0 * mesh.coordinate(i, before) + 1.0);
  const std::vector<double> carried = carried_over(mesh, values, 1, false, before, after);
  for (int i = 0; i < mesh.vertices(); ++i) {
    const double s = mesh.coordinate(i, after);
    EXPECT_NEAR(carried[static_cast<std::size_t>(i)], s < 0.0 ? 0.0 : 3.0 * s + 1.0, 1e-14);
  }
}

}  // namespace
}  // namespace snare::wire
