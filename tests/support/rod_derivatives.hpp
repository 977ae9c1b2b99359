#pragma once

#include "numerics/band_matrix.hpp"
#include "tests/support/derivatives.hpp"
#include "wire/planar_rod.hpp"
#include "wire/spatial_rod.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <array>

namespace snare::test {

/// The whole symmetric matrix.
[[nodiscard]] inline Eigen::MatrixXd dense(const numerics::SymmetricBandMatrix& a) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(a.order(), a.order());
  for (int j = 0; j < a.order(); ++j) {
    for (int i = j; i < a.order() && i - j <= a.half_bandwidth(); ++i) {
      full(i, j) = a.lower(i, j);
      full(j, i) = a.lower(i, j);
    }
  }
  return full;
}

/// A state moved to other unknowns, its frames (if any) carried along.
[[nodiscard]] inline wire::PlanarState moved_to(wire::PlanarState state, const Eigen::VectorXd& q) {
  state.q = q;
  return state;
}
[[nodiscard]] inline wire::SpatialState moved_to(wire::SpatialState state, const Eigen::VectorXd& q) {
  wire::accept(state, q);
  return state;
}

template <class Rod, class State>
[[nodiscard]] wire::RodAssembly assembled(const Rod& rod, const State& state) {
  wire::RodAssembly assembly;
  rod.assemble(state, {true, true, true}, assembly);
  return assembly;
}

/// Every derivative of a rod beside differences at one state.
struct RodDerivativeErrors {
  DerivativeError gradient;          ///< of the energy by q
  DerivativeError hessian;           ///< symmetric part of the gradient by q
  DerivativeError control_columns;   ///< gradient by the controls
  DerivativeError control_gradient;  ///< energy by the controls
  DerivativeError control_hessian;   ///< control gradient by the controls
  double energy_mismatch = 0.0;      ///< |energy() - assembled energy|
};

template <class Rod, class State>
[[nodiscard]] RodDerivativeErrors check_rod_derivatives(const Rod& rod, const State& state) {
  using Eigen::VectorXd;
  const wire::RodAssembly at = assembled(rod, state);
  const double edge = rod.mesh().rest_length(0, state.controls);
  RodDerivativeErrors errors;
  errors.energy_mismatch = std::abs(at.energy - rod.energy(state));
  errors.gradient = compare_gradient([&](const VectorXd& q) { return rod.energy(moved_to(state, q)); },
                                     state.q, at.gradient, edge);
  errors.hessian =
      compare_symmetric_part([&](const VectorXd& q) { return assembled(rod, moved_to(state, q)).gradient; },
                             state.q, dense(at.hessian), edge);

  const auto with_controls = [&](const VectorXd& controls) {
    State other = state;
    for (int k = 0; k < 3; ++k) other.controls[static_cast<std::size_t>(k)] = controls[k];
    return other;
  };
  const VectorXd controls =
      Eigen::Vector3d(state.controls.left, state.controls.contact, state.controls.right);
  Eigen::MatrixXd columns(rod.unknowns(), 3);
  for (int k = 0; k < 3; ++k) columns.col(k) = at.control_columns[static_cast<std::size_t>(k)];
  errors.control_columns = compare_jacobian(
      [&](const VectorXd& c) { return assembled(rod, with_controls(c)).gradient; }, controls, columns);
  errors.control_gradient = compare_gradient([&](const VectorXd& c) { return rod.energy(with_controls(c)); },
                                             controls, at.control_gradient);
  errors.control_hessian = compare_jacobian(
      [&](const VectorXd& c) { return VectorXd(assembled(rod, with_controls(c)).control_gradient); },
      controls, at.control_hessian);
  return errors;
}

/// Fourth-order differences reach 1e-12 of the largest entry at their best step, about 1e-3 of an edge
/// (truncation h^4 against round-off 1e-16/h); a wrong or missing term is of order 1e-2. A margin of 100 for
/// other seeds.
inline constexpr double difference_error = 1e-10;

inline void expect_exact(const RodDerivativeErrors& errors) {
  EXPECT_LT(errors.gradient.relative, difference_error) << errors.gradient.worst;
  EXPECT_LT(errors.hessian.relative, difference_error) << errors.hessian.worst;
  EXPECT_LT(errors.control_columns.relative, difference_error) << errors.control_columns.worst;
  EXPECT_LT(errors.control_gradient.relative, difference_error) << errors.control_gradient.worst;
  EXPECT_LT(errors.control_hessian.relative, difference_error) << errors.control_hessian.worst;
  EXPECT_LT(errors.energy_mismatch, 1e-13);  // order-one sums of 30 terms in another order
}

}  // namespace snare::test
