#include "wire/motion/rod_forces.hpp"

#include "numerics/dae.hpp"
#include "tests/support/random_rods.hpp"
#include "wire/motion/rod_part.hpp"
#include "wire/motion/rod_stiffness.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <ostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace snare::wire {
namespace {

using Eigen::Matrix3Xd;
using Eigen::VectorXd;

/// A crooked rod of some elements in motion: bent and twisted so much that every formula for small angles
/// ends somewhere.
struct Crooked {
  int elements;
  Formulation formulation;
  double amount;  // of an edge's length, and of a radian
  friend void PrintTo(const Crooked& c, std::ostream* out) {
    *out << c.elements << (c.formulation == Formulation::vertices ? " plain" : " of higher order") << ", by "
         << c.amount;
  }
};

RodInMotion rod_of(const Crooked& c) {
  RodInMotion rod;
  rod.properties = test::general_properties();
  rod.mass_per_length = 0.3;
  rod.length = 1.0;
  rod.elements = c.elements;
  rod.grading = 1.0;
  rod.formulation = c.formulation;
  return rod;
}

struct Moved {
  RodPart part;
  numerics::DaeSystem system;
  VectorXd y, rate;
  std::mt19937 random{5};
  std::uniform_real_distribution<double> unit{-1.0, 1.0};

  Moved(const RodInMotion& rod, double amount) : part("wire", rod, {}), system({&part}) {
    y = rate = VectorXd::Zero(system.size());
    Matrix3Xd positions(3, part.vertices());
    for (int i = 0; i < part.vertices(); ++i) {
      const double step = amount / rod.elements;
      positions.col(i) << part.coordinate(i) + 0.5 * step * unit(random), step * unit(random),
          step * unit(random);
    }
    part.place(positions, {}, y);
    for (int i = 0; i < part.vertices(); ++i) {
      for (int k = 0; k < 3; ++k) y[part.velocity_of(i) + k] = part.is_held(i, k) ? 0.0 : 0.1 * unit(random);
      if (i < rod.elements) {
        y[part.angle_of(i)] += amount * unit(random);
        rate[part.angle_of(i)] = 0.1 * unit(random);
      }
      if (rod.formulation == Formulation::higher_order) {
        for (int k = 0; k < 2; ++k) y[part.model().curvature_of(i) + k] += amount * unit(random);
      }
    }
  }
  [[nodiscard]] double energy(const VectorXd& at) {
    const RodPart::Energies e = part.energies({0.0, at, rate});
    return e.strain + e.potential;
  }
};

class RodForcesOf : public testing::TestWithParam<Crooked> {};
class RodForcesOfPlain : public testing::TestWithParam<Crooked> {};

// Plain rods against the assembly of statics, vertex by vertex: energy, gradient, second derivatives.
TEST_P(RodForcesOfPlain, AreThoseOfStatics) {
  const Crooked& c = GetParam();
  Moved m(rod_of(c), c.amount);
  const RodModel& model = m.part.model();
  VectorXd q(model.bands());
  for (int band = 0; band < model.bands(); ++band) q[band] = m.y[model.unknown_of(band)];
  // Directors are carried from the start, where angles were zero.
  VectorXd start = q;
  for (int e = 0; e < model.vertices(); ++e) start[RodModel::block * e + RodModel::angle] = 0.0;
  SpatialState state = model.rod().make_state(start, model.controls());
  accept(state, q);
  RodAssembly expected;
  model.rod().assemble(state, {false, false, false}, expected);

  EXPECT_NEAR(m.energy(m.y), expected.energy, 1e-12 * std::abs(expected.energy));
  VectorXd rows(m.y.size());
  m.system.residual({0.0, m.y, m.rate}, rows);
  const numerics::SparseMatrix& jacobian = m.system.jacobian({0.0, m.y, m.rate}, 0.0);
  const double size = expected.gradient.norm();
  double largest = 0.0, off = 0.0;
  for (int i = 0; i + 1 < model.bands(); ++i) {
    if (model.is_held(i)) continue;
    EXPECT_NEAR(rows[model.balance_of(i)], expected.gradient[i], 1e-12 * size);
    for (int j = 0; j <= i; ++j) {
      if (model.is_held(j) || i - j > SpatialRod::half_bandwidth) continue;
      const int slot = jacobian.slot(model.balance_of(i), model.unknown_of(j));
      const double value = slot < 0 ? 0.0 : jacobian.value[base::at(slot)];
      const double exact = expected.hessian.column(j)[i - j];
      largest = std::max(largest, std::abs(exact));
      off = std::max(off, std::abs(value - exact));
    }
  }
  EXPECT_LT(off, 1e-13 * largest);
}

// Along some direction: the slope of the energy, and its curvature by the Jacobian.
TEST_P(RodForcesOf, AreDerivativesOfTheEnergy) {
  const Crooked& c = GetParam();
  Moved m(rod_of(c), c.amount);
  const RodModel& model = m.part.model();
  VectorXd rows(m.y.size());
  m.system.residual({0.0, m.y, m.rate}, rows);
  const numerics::SparseMatrix& jacobian = m.system.jacobian({0.0, m.y, m.rate}, 0.0);
  std::vector<std::pair<int, int>> moved;  // unknown and balance
  for (int i = 0; i + 1 < model.bands(); ++i) {
    if (!model.is_held(i)) moved.emplace_back(model.unknown_of(i), model.balance_of(i));
  }
  for (int i = 0; model.is_curved() && i < model.vertices(); ++i) {
    for (int k = 0; k < 2; ++k) moved.emplace_back(model.curvature_of(i) + k, model.curvature_of(i) + k);
  }
  for (int trial = 0; trial < 3; ++trial) {
    VectorXd d = VectorXd::Zero(m.y.size());
    for (const auto& [unknown, balance] : moved) d[unknown] = m.unit(m.random) / c.elements;
    double slope = 0.0, curvature = 0.0;
    for (const auto& [unknown, balance] : moved) {
      slope += rows[balance] * d[unknown];
      for (const auto& [other, row] : moved) {
        const int slot = jacobian.slot(balance, other);
        if (slot >= 0) curvature += d[unknown] * jacobian.value[base::at(slot)] * d[other];
      }
    }
    // Five points.
    const double h = 5e-4;
    const auto e = [&](double s) { return m.energy(m.y + s * d); };
    const double here = e(0.0), p1 = e(h), m1 = e(-h), p2 = e(2.0 * h), m2 = e(-2.0 * h);
    const double size = std::abs(here);
    EXPECT_NEAR(slope, (8.0 * (p1 - m1) - (p2 - m2)) / (12.0 * h), 1e-8 * size);
    EXPECT_NEAR(curvature, (16.0 * (p1 + m1) - (p2 + m2) - 30.0 * here) / (12.0 * h * h), 1e-6 * size);
  }
}

// What damping takes is its forces times the rates.
TEST_P(RodForcesOf, TakeThePowerOfDamping) {
  const Crooked& c = GetParam();
  RodInMotion rod = rod_of(c);
  rod.damping.bending_time = 0.02;
  rod.damping.axial_time = 0.03;
  const RodInMotion undamped = rod_of(c);
  Moved with(rod, c.amount), without(undamped, c.amount);
  VectorXd rows(with.y.size()), elastic(with.y.size());
  with.system.residual({0.0, with.y, with.rate}, rows);
  without.system.residual({0.0, without.y, without.rate}, elastic);
  const RodModel& model = with.part.model();
  double power = 0.0;
  for (int i = 0; i + 1 < model.bands(); ++i) {
    if (model.is_held(i)) continue;
    const double speed = RodModel::is_angle(i) ? with.rate[model.unknown_of(i)] : with.y[model.rate_of(i)];
    power += (rows - elastic)[model.balance_of(i)] * speed;
  }
  const double taken = with.part.energies({0.0, with.y, with.rate}).dissipation;
  EXPECT_GT(taken, 0.0);
  EXPECT_NEAR(power, taken, 1e-12 * taken);
}

// Processors that work on four numbers at once and those that do not give the same bits.
TEST_P(RodForcesOf, AreTheSameBitsFourAndTwoAtATime) {
  if (!numerics::has_four_lanes()) GTEST_SKIP() << "this processor works on two numbers at once";
  const Crooked& c = GetParam();
  RodInMotion rod = rod_of(c);
  rod.damping.bending_time = 0.02;
  rod.damping.axial_time = 0.03;
  Moved m(rod, c.amount);
  const RodModel& model = m.part.model();
  const numerics::DaePoint at{0.0, m.y, m.rate};
  RodInstant accepted;
  VectorXd q(model.bands());
  for (int band = 0; band < model.bands(); ++band)
    q[band] = RodModel::is_angle(band) ? 0.0 : m.y[model.unknown_of(band)];
  accepted.state = model.rod().make_state(q, model.controls());
  accepted.take_edges();
  std::vector<std::pair<int, int>> entries;
  append_sparsity(model, entries);
  numerics::SparseMatrix pattern = numerics::make_pattern(m.system.size(), entries);
  RodSlots slots;
  slots.attach(model, pattern);
  struct Outcome {
    RodAssembly assembly;
    Eigen::Matrix2Xd by_curvature;
    RodLosses losses;
    std::vector<double> values;
  };
  const auto of = [&](bool four, const std::optional<RodPlane>& plane) {
    Outcome o;
    RodForces forces(model, four);
    forces.restrict_to_plane(plane);
    forces.take_frames(accepted);
    RodInstant trial = accepted;
    for (int band = 0; band < model.bands(); ++band) trial.state.q[band] = m.y[model.unknown_of(band)];
    forces.evaluate(model, at, trial, {o.assembly, o.by_curvature, o.losses});
    RodStiffness stiffness(model, four);
    stiffness.restrict_to_plane(plane);
    stiffness.attach(model, slots);
    o.values.assign(pattern.value.size(), 0.0);
    stiffness.add(model, {forces.rows(), trial, at, 7.0}, o.values);
    return o;
  };
  for (const std::optional<RodPlane>& plane :
       {std::optional<RodPlane>(), std::optional(RodPlane{1, {2, 0}, 1, -1.0})}) {
    const Outcome four = of(true, plane), two = of(false, plane);
    EXPECT_EQ(four.assembly.energy, two.assembly.energy);
    EXPECT_EQ(four.losses.power, two.losses.power);
    EXPECT_EQ(four.assembly.gradient, two.assembly.gradient);
    EXPECT_EQ(four.by_curvature, two.by_curvature);
    EXPECT_EQ(four.values, two.values);
  }
}

// One to three vertices beside the last four, and none.
std::vector<Crooked> crooked(Formulation formulation) {
  std::vector<Crooked> list;
  for (int n = 4; n <= 12; ++n) list.push_back({n, formulation, 0.1});
  for (const int n : {7, 13}) list.push_back({n, formulation, 0.7});
  return list;
}

INSTANTIATE_TEST_SUITE_P(Plain, RodForcesOfPlain, testing::ValuesIn(crooked(Formulation::vertices)));
INSTANTIATE_TEST_SUITE_P(Plain, RodForcesOf, testing::ValuesIn(crooked(Formulation::vertices)));
INSTANTIATE_TEST_SUITE_P(OfHigherOrder, RodForcesOf, testing::ValuesIn(crooked(Formulation::higher_order)));

// Where no four vertices are left, what stands for the others continues as the wire does: no turn from x to
// -x.
TEST(RodForces, AreNoneOfAStraightWireWhereverItPoints) {
  for (const Formulation formulation : {Formulation::vertices, Formulation::higher_order}) {
    for (int elements = 4; elements <= 8; ++elements) {
      for (const double sign : {1.0, -1.0}) {
        for (int axis = 0; axis < 3; ++axis) {
          RodInMotion rod;
          rod.properties = test::round_properties();
          rod.properties.weight.setZero();
          rod.properties.right.translational_stiffness = std::numeric_limits<double>::infinity();
          const Eigen::Vector3d along = sign * Eigen::Vector3d::Unit(axis);
          for (SpatialEnd* end : {&rod.properties.left, &rod.properties.right}) {
            end->kind = SpatialEnd::Kind::clamp;
            if (end == &rod.properties.right) end->position = along;
            end->direction = along;
            end->director = Eigen::Vector3d::Unit((axis + 1) % 3);
            end->twist_angle = 0.0;
          }
          rod.mass_per_length = 0.3;
          rod.length = 1.0;
          rod.elements = elements;
          rod.formulation = formulation;
          rod.damping = {0.1, 0.1, 0.0};
          RodPart part("wire", rod, {});
          numerics::DaeSystem system({&part});
          VectorXd y = VectorXd::Zero(system.size());
          Matrix3Xd positions(3, part.vertices());
          for (int i = 0; i < part.vertices(); ++i) positions.col(i) = part.coordinate(i) * along;
          part.place(positions, {}, y);
          const numerics::DaePoint at{0.0, y, VectorXd::Zero(y.size())};
          VectorXd rows(y.size());
          system.residual(at, rows);
          EXPECT_LT(rows.cwiseAbs().maxCoeff(), 1e-13) << elements << " along " << along.transpose();
          for (const double v : system.jacobian(at, 1.0).value)
            ASSERT_TRUE(std::isfinite(v)) << along.transpose();
        }
      }
    }
  }
}

}  // namespace
}  // namespace snare::wire
