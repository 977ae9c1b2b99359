#include "wire/edge_beam.hpp"

#include "base/index.hpp"

namespace snare::wire {

using Eigen::Vector2d;

Flexibilities flexibilities(double z) {
  return flexibilities_at(z);
}

EdgeBeam edge_beam(const EdgeBeamConstants& p, double chord, const Vector2d& near, const Vector2d& far,
                   EdgeDerivatives wanted) {
  const double h = p.rest;
  const Vector2d& ei = p.bending_stiffness;
  const BalancedBeam<double> balanced =
      balanced_beam<double>(h, chord, {near[0], near[1]}, {far[0], far[1]}, p.axial_stiffness, ei);
  EdgeBeam b;
  b.tension = balanced.tension;
  b.energy = balanced.energy;
  b.gradient << balanced.tension, balanced.near[0], balanced.near[1], balanced.far[0], balanced.far[1];
  if (wanted == EdgeDerivatives::first) return b;

  const Vector2d sum = near + far;
  const Vector2d difference = near - far;
  Eigen::Matrix<double, EdgeBeam::count, 1> by_tension;  // d2/dN d(l, k)
  by_tension[EdgeBeam::chord] = 1.0;
  b.hessian.setZero();
  for (int j = 0; j < 2; ++j) {
    const auto& [c, d] = balanced.of[base::at(j)];
    const int a = EdgeBeam::near + j;
    const int z = EdgeBeam::far + j;
    by_tension[a] = -0.5 * h * h * h * balanced.lever * (c.first * sum[j] + d.first * difference[j]);
    by_tension[z] = -0.5 * h * h * h * balanced.lever * (c.first * sum[j] - d.first * difference[j]);
    b.hessian(a, a) = b.hessian(z, z) = -0.5 * h * ei[j] * (c.value + d.value);
    b.hessian(a, z) = b.hessian(z, a) = -0.5 * h * ei[j] * (c.value - d.value);
  }
  // N eliminated: H - H_N H_N^T/H_NN.
  b.hessian += by_tension * by_tension.transpose() / balanced.softness;
  return b;
}

}  // namespace snare::wire
