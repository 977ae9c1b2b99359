#pragma once

#include "wire/statics/equilibrium.hpp"

#include <Eigen/Core>

#include <array>
#include <functional>

namespace snare::test {

/// A rod with a dead force on its last vertex; takes the place of a rod in find_equilibrium.
template <class Rod>
class TipLoadedRod {
 public:
  static constexpr int dimension = Rod::dimension;
  static constexpr int block = Rod::block;
  using Force = Eigen::Matrix<double, Rod::dimension, 1>;

  TipLoadedRod(Rod rod, const Force& force) : rod_(std::move(rod)), force_(force) {}

  [[nodiscard]] const Rod& rod() const { return rod_; }
  [[nodiscard]] const auto& mesh() const { return rod_.mesh(); }
  [[nodiscard]] const auto& properties() const { return rod_.properties(); }

  template <class State>
  void assemble(const State& state, const std::array<bool, 3>& wanted, wire::RodAssembly& out) const {
    rod_.assemble(state, wanted, out);
    const int row = Rod::block * rod_.mesh().edges();
    out.energy -= force_.dot(state.q.template segment<Rod::dimension>(row));
    out.gradient.template segment<Rod::dimension>(row) -= force_;
  }
  void hold_mounts(wire::RodAssembly& assembly) const { rod_.hold_mounts(assembly); }
  template <class State>
  [[nodiscard]] Eigen::VectorXd tensions(const State& state) const {
    return rod_.tensions(state);
  }

 private:
  Rod rod_;
  Force force_;
};

/// Negative pivots of the Hessian with the mounts held; -1 when it cannot be factorised.
template <class Rod, class State>
[[nodiscard]] int negative_pivots(const Rod& rod, const State& state) {
  wire::RodAssembly assembly;
  rod.assemble(state, {false, false, false}, assembly);
  rod.hold_mounts(assembly);
  numerics::BandLdlt factor;
  return factor.factorize(assembly.hessian) ? factor.negative_pivots() : -1;
}

/// Load in (low, high) at which `unstable` becomes true, to a relative 1e-12.
[[nodiscard]] inline double critical_load(double low, double high,
                                          const std::function<bool(double)>& unstable) {
  while (high - low > 1e-12 * high) {
    const double middle = 0.5 * (low + high);
    (unstable(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// From values at n, 2n and 4n edges: the limit for errors of second and third order (the half cells at the
/// mounts leave one of third), and the observed order.
struct Extrapolation {
  double limit = 0.0;
  double order = 0.0;
};
[[nodiscard]] inline Extrapolation extrapolate(const std::array<double, 3>& values) {
  const double coarse = (4.0 * values[1] - values[0]) / 3.0;
  const double fine = (4.0 * values[2] - values[1]) / 3.0;
  return {(8.0 * fine - coarse) / 7.0,
          std::log2(std::abs((values[1] - values[0]) / (values[2] - values[1])))};
}

}  // namespace snare::test
