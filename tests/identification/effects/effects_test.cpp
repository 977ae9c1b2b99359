// Every effect: what holds for all of them (EachEffect), then facts that follow from mechanics, whatever the
// data.

#include "identification/effects/catalogue.hpp"
#include "identification/fitting/least_squares.hpp"
#include "identification/tracing/projection.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace snare::identification {
namespace {

using test::mm;

/// A series of the strand-like wire, loaded and unloaded, without readings of its own.
Series series_at(double position, double span, int readings) {
  Series s;
  s.name = "s" + std::to_string(static_cast<int>(1e3 * position)) + "_" +
           std::to_string(static_cast<int>(1e4 * span));
  s.test = test::declared_wire(position, 6.0 * mm);
  s.test.wire.length = 176.0 * mm;
  s.test.wire.bending_stiffness_override = 0.024;
  s.test.wire.axial_stiffness_override = 170e3;
  s.test.wire.construction = wire::Construction::strand;
  s.test.mount.span = span;
  Readings r;
  for (int i = 1; i <= readings; ++i) r.displacement.push_back(2.4 * mm * i / readings);
  for (int i = readings - 1; i >= 1; --i) r.displacement.push_back(2.4 * mm * i / readings);
  r.force.assign(r.displacement.size(), 0.0);
  s.readings = r;
  return s;
}

std::vector<Series> three_positions_two_slacks() {
  std::vector<Series> all;
  for (const double span : {175.0 * mm, 175.5 * mm}) {
    for (const double position : {40.0 * mm, 65.0 * mm, 90.0 * mm})
      all.push_back(series_at(position, span, 15));
  }
  return all;
}

SolverSettings few_edges() {
  SolverSettings s;
  s.elements = 64;
  return s;
}

/// Readings that the model itself gives, noise of 0.05 N declared.
Data data_of(const Model& model) {
  Data data;
  const Evaluation at = model.evaluate({});
  for (std::size_t k = 0; k < model.series().size(); ++k) {
    data.series.push_back(k);
    data.measured.push_back(at.force[k]);
    data.noise.sigma.push_back(0.05);
  }
  data.noise.source = "declared";
  return data;
}

Eigen::VectorXd column(const Model& model, const Data& data, const char* key) {
  return data.jacobian(model.evaluate({}, {&parameters().at(key)}));
}

double cosine(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.dot(b) / (a.norm() * b.norm());
}

TEST(Effects, HaveDifferentNamesAndNumbers) {
  std::set<std::string> names;
  std::set<std::string> keys(parameters().keys().begin(), parameters().keys().end());
  EXPECT_EQ(keys.size(), parameters().keys().size()) << "a key is there twice";
  for (const Effect& e : catalogue()) {
    EXPECT_TRUE(names.insert(e.name).second) << e.name << " is there twice";
    EXPECT_EQ(find_effect(e.name), &e);
    for (const EffectNumber& n : e.numbers) EXPECT_EQ(parameters().find(n.parameter.key), &n.parameter);
  }
  EXPECT_EQ(find_effect("witchcraft"), nullptr);
}

/// What holds for every effect of the catalogue; a new one is tested by being in the list.
class EachEffect : public testing::TestWithParam<const Effect*> {};

/// "rad/(N m)" ends a key as "rad_Nm".
std::string unit_in_key(const std::string& unit) {
  std::string result;
  for (const char c : unit) {
    if (c == '/')
      result += '_';
    else if (c != ' ' && c != '^' && c != '(' && c != ')')
      result += c;
  }
  return result;
}

TEST_P(EachEffect, SaysWhatItIs) {
  const Effect& e = *GetParam();
  EXPECT_FALSE(e.meaning.empty());
  EXPECT_FALSE(e.independent_check.empty());
  ASSERT_FALSE(e.numbers.empty());
  Series series = series_at(65.0 * mm, 175.0 * mm, 15);
  const PushProblem declared = series.test;
  ReadingModel reading;
  for (const EffectNumber& n : e.numbers) {
    SCOPED_TRACE(n.parameter.key);
    const Parameter& p = n.parameter;
    EXPECT_TRUE(p.key.ends_with(unit_in_key(p.unit))) << p.unit;
    EXPECT_GT(p.step, 0.0);
    EXPECT_LT(n.plausible_lower, n.plausible_upper);
    const auto [lower, upper] = p.limits(declared);
    ASSERT_LT(lower, upper);
    // What is set is what is got, and what a coordinate stands for. Roundings only.
    const double value = lower + 0.3 * (upper - lower);
    p.number.set(series.test, reading, value);
    EXPECT_NEAR(p.number.get(series.test, reading), value, 1e-12 * std::abs(value));
    EXPECT_NEAR(p.value(0.7, p.coordinate(0.7, 0.4)), 0.4, 1e-15);
  }
}

// By hand or by implicit differentiation, against differences of whole curves. One-sided numbers at their
// end: to one side.
TEST_P(EachEffect, DerivativeMatchesDifferences) {
  const Effect& e = *GetParam();
  const Parameter& p = e.numbers.front().parameter;
  if (e.trials != nullptr) return;  // has no derivative at null
  // Clamps that give, so that a natural curvature shows; times, so that a rate does.
  Series series = series_at(40.0 * mm, 175.0 * mm, 15);
  series.test.mount.rotational_stiffness = 2.0;
  for (std::size_t i = 0; i < series.readings->force.size(); ++i)
    series.readings->time.push_back(0.1 * static_cast<double>(i));
  series.largest_displacement = 2.4 * mm;  // of the sensors' ranges
  series.largest_force = 100.0;
  ASSERT_TRUE(coupling::differentiable(series.test));
  const Model model({series}, few_edges());
  const Evaluation here = model.evaluate({}, {&p});
  ASSERT_TRUE(here.complete) << here.message;
  const auto force = [&](double coordinate) -> Eigen::VectorXd {
    return model.evaluate({{&p, coordinate}}).force[0];
  };
  const double h = p.parametrisation == Parametrisation::shift ? 100.0 * p.step : p.step;
  const bool at_end = p.number.get(series.test, {}) <= p.limits(series.test).lower;
  Eigen::VectorXd difference;
  if (at_end) {
    difference = (4.0 * force(h) - force(2.0 * h) - 3.0 * force(0.0)) / (2.0 * h);
  } else {
    difference = (force(h) - force(-h)) / (2.0 * h);
  }
  ASSERT_GT(difference.norm(), 0.0);
  // Derivatives carry the mesh's error (see score.cpp), whatever the step: extrapolated from 64 edges 5 mN
  // for a change of EI or EA by its own size, which is 3e-3 of what EA does here; 24 mN on that mesh alone.
  EXPECT_LT((here.by[0].col(0) - difference).norm(), 5e-3 * difference.norm());
}

// Where the mounts are rigid their compliance is differentiated as such, elsewhere as any number: both must
// hold.
TEST(MountAxialCompliance, DerivativeAwayFromRigidMountsMatchesDifferences) {
  const Parameter& p = parameters().at("mount_axial_compliance.compliance_m_N");
  const Model model({series_at(40.0 * mm, 175.0 * mm, 15)}, few_edges());
  const auto force = [&](double coordinate) -> Eigen::VectorXd {
    return model.evaluate({{&p, coordinate}}).force[0];
  };
  constexpr double at = 2e-7;  // [m/N]; the wire itself gives 1e-6
  constexpr double h = 1e-9;
  const Evaluation here = model.evaluate({{&p, at}}, {&p});
  ASSERT_TRUE(here.complete) << here.message;
  const Eigen::VectorXd difference = (force(at + h) - force(at - h)) / (2.0 * h);
  // As for every effect: the derivative has the mesh's error.
  EXPECT_LT((here.by[0].col(0) - difference).norm(), 5e-3 * difference.norm());
}

// A fit may begin at rigid clamps: differences by their compliance reach below zero there.
TEST(MountRotationalCompliance, DerivativeAtRigidClampsMatchesDifferences) {
  const Parameter& p = parameters().at("mount_rotational_compliance.compliance_rad_Nm");
  const Model model({series_at(40.0 * mm, 175.0 * mm, 15)}, few_edges());
  const auto force = [&](double coordinate) -> Eigen::VectorXd {
    return model.evaluate({{&p, coordinate}}).force[0];
  };
  constexpr double h = 1e-4;  // [rad/(N m)]; the wire itself turns by L/EI = 4
  const Eigen::VectorXd difference = (4.0 * force(h) - force(2.0 * h) - 3.0 * force(0.0)) / (2.0 * h);
  const Evaluation here = model.evaluate({}, {&p});
  ASSERT_TRUE(here.complete) << here.message;
  EXPECT_LT((here.by[0].col(0) - difference).norm(), 5e-3 * difference.norm());
}

// Of two mounts that give alike each gives by itself; and a push at 40 mm of which the left one gives is the
// mirror image of one at 135 mm of which the right one does.
TEST(MountsByThemselves, TogetherAreBothAndMirrorEachOther) {
  struct Pair {
    const char* both;
    const char* left;
    const char* right;
    double size;
  };
  for (const Pair& pair :
       {Pair{"mount_axial_compliance.compliance_m_N", "mount_axial_compliance_left.compliance_m_N",
             "mount_axial_compliance_right.compliance_m_N", 1e-6},
        Pair{"mount_rotational_compliance.compliance_rad_Nm",
             "mount_rotational_compliance_left.compliance_rad_Nm",
             "mount_rotational_compliance_right.compliance_rad_Nm", 0.5}}) {
    SCOPED_TRACE(pair.both);
    const Model near({series_at(40.0 * mm, 175.0 * mm, 15)}, few_edges());
    const Model far({series_at(135.0 * mm, 175.0 * mm, 15)}, few_edges());
    const Setting left{&parameters().at(pair.left), pair.size},
        right{&parameters().at(pair.right), pair.size};
    const Eigen::VectorXd both = near.evaluate({{&parameters().at(pair.both), pair.size}}).force[0];
    // The same numbers in the same places.
    EXPECT_EQ((near.evaluate({left, right}).force[0] - both).norm(), 0.0);
    const Eigen::VectorXd by_left = near.evaluate({left}).force[0];
    EXPECT_GT((by_left - both).norm(), 1e-3 * both.norm());
    // Round-off of Newton's method.
    EXPECT_LT((by_left - far.evaluate({right}).force[0]).norm(), 1e-6 * by_left.norm());
  }
}

std::vector<const Effect*> each() {
  std::vector<const Effect*> all;
  for (const Effect& e : catalogue()) all.push_back(&e);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Catalogue, EachEffect, testing::ValuesIn(each()),
                         [](const auto& one) { return one.param->name; });

// A uniform natural curvature adds a constant to the moment of a wire whose ends keep their directions: no
// force changes.
TEST(Effects, NaturalCurvatureIsInvisibleBetweenRigidClamps) {
  const Model model({series_at(65.0 * mm, 175.0 * mm, 15)}, few_edges());
  const Data data = data_of(model);
  const Eigen::VectorXd change = column(model, data, "wire.natural_curvature_1_m");
  const Eigen::VectorXd stiffness = column(model, data, "wire.bending_stiffness_Nm2");
  // 1 1/m against a change of EI by its own size. The rod's curvature 2 tan(phi/2) sums up to the turning of
  // the ends to the square of an edge's turning: 1e-4 on 64 edges.
  EXPECT_LT(change.norm(), 2e-4 * stiffness.norm());
  EXPECT_FALSE(find_effect("natural_curvature")->unobservable(model.series()).empty());
  std::vector<Series> giving{series_at(65.0 * mm, 175.0 * mm, 15)};
  giving.front().test.mount.rotational_stiffness = 2.0;
  EXPECT_TRUE(find_effect("natural_curvature")->unobservable(giving).empty());
}

// Forces are homogeneous of degree one in (EI, EA).
TEST(Effects, GainLiesInTheSpanOfTheStiffnesses) {
  const Model model(three_positions_two_slacks(), few_edges());
  const Data data = data_of(model);
  const Eigen::VectorXd gain = column(model, data, "reading.force_gain");
  Eigen::MatrixXd base(gain.size(), 2);
  base << column(model, data, "wire.bending_stiffness_Nm2"), column(model, data, "wire.axial_stiffness_N");
  // Extrapolated from 64 edges, forces and derivatives alike.
  EXPECT_LT((base.rowwise().sum() - gain).norm(), 1e-5 * gain.norm());
  EXPECT_LT(Projection(base).without(gain).norm(), 1e-5 * gain.norm());
}

// Where the wire is a string, its stretch and that of the mounts add up, and a gain is nothing else: one
// class.
TEST(Effects, AxialStiffnessMountComplianceAndGainAreAlikeForAString) {
  std::vector<Series> taut;
  for (const double position : {40.0 * mm, 65.0 * mm, 90.0 * mm}) {
    taut.push_back(series_at(position, 176.0 * mm, 15));
    taut.back().test.wire.bending_stiffness_override = 1e-4;
  }
  const Model model(taut, few_edges());
  const Data data = data_of(model);
  const Eigen::VectorXd axial = column(model, data, "wire.axial_stiffness_N");
  EXPECT_GT(std::abs(cosine(axial, column(model, data, "mount_axial_compliance.compliance_m_N"))), 0.999);
  EXPECT_GT(std::abs(cosine(axial, column(model, data, "reading.force_gain"))), 0.999);
}

// A stretched string hands half of its weight to the pusher, whatever the travel: a force offset at one
// position. It also sags before the touch, from which the travel counts: a zero of the travel, which the fit
// must be free to move.
TEST(Effects, GravityIsAForceOffsetAtOnePosition) {
  std::vector<Series> taut{series_at(65.0 * mm, 176.4 * mm, 15)};
  taut.front().test.wire.bending_stiffness_override = 1e-4;
  const Model model(taut, few_edges());
  const Data data = data_of(model);
  Eigen::MatrixXd base(data.rows(), 2);
  base << column(model, data, "wire.axial_stiffness_N"),
      column(model, data, "reading.displacement_offset_mm");
  const Projection fitted(base);
  const Eigen::VectorXd weight = fitted.without(column(model, data, "gravity.along_bulge_m_s2"));
  const Eigen::VectorXd offset = fitted.without(column(model, data, "reading.force_offset_N"));
  EXPECT_GT(std::abs(cosine(weight, offset)), 0.95);
}

// Friction and stick-slip resist whichever way the pusher moves: to first order they show in half the
// difference of loading and unloading, not in the mean.
TEST(Effects, FrictionAndStrandsShowBetweenLoadingAndUnloading) {
  const int n = 40;
  const Model model({series_at(40.0 * mm, 175.0 * mm, n)}, few_edges());
  const Evaluation plain = model.evaluate({});
  const auto parts = [&](const std::vector<Setting>& settings) {
    const Evaluation with = model.evaluate(settings);
    EXPECT_TRUE(with.complete) << with.message;
    const Eigen::VectorXd change = with.force[0] - plain.force[0];
    // Readings i and 2n - 2 - i have the same travel. Away from the turning points, where both stick.
    double mean = 0.0;
    double half = 0.0;
    for (int i = n / 4; i < 3 * n / 4; ++i) {
      const double up = change[i];
      const double down = change[2 * n - 2 - i];
      mean += std::pow(0.5 * (up + down), 2);
      half += std::pow(0.5 * (up - down), 2);
    }
    return std::sqrt(mean / half);
  };
  // What is left in the mean is of second order: the friction coefficient, the loop's own change of shape.
  EXPECT_LT(parts({{&parameters().at("pusher.friction"), 0.02}}), 0.1);
  EXPECT_LT(parts({{&parameters().at("strand_hysteresis.extra_stiffness_Nm2"), 0.02 * 0.024},
                   {&parameters().at("strand_hysteresis.slip_curvature_1_m"), std::log(0.02)}}),
            0.15);
}

TEST(Effects, WhatCannotBeSeenIsSaid) {
  Series supported = series_at(20.0 * mm, 40.0 * mm, 15);
  supported.test.mount.kind = wire::MountKind::supports;
  supported.test.wire.length = 60.0 * mm;
  for (const char* name : {"wire_length", "mount_slip", "mount_axial_compliance",
                           "mount_rotational_compliance", "natural_curvature"}) {
    EXPECT_FALSE(find_effect(name)->unobservable({supported}).empty()) << name;
  }
  EXPECT_FALSE(find_effect("rate_viscosity")->unobservable({supported}).empty());  // no times
  supported.readings->time.assign(supported.readings->displacement.size(), 0.0);
  EXPECT_TRUE(find_effect("rate_viscosity")->unobservable({supported}).empty());
  supported.test.wire.construction = wire::Construction::solid;
  EXPECT_FALSE(find_effect("strand_hysteresis")->unobservable({supported}).empty());
}

}  // namespace
}  // namespace snare::identification
