#include "wire/motion/edge_beam.hpp"

#include "base/index.hpp"

namespace snare::wire {

using Eigen::Vector2d;

Flexibilities flexibilities(double z) {
  return flexibilities_at(z);
}

EdgeBeam edge_beam(const EdgeBeamConstants& p, double chord, const Vector2d& near, const Vector2d& far) {
  const Pair<double> ei{p.bending_stiffness[0], p.bending_stiffness[1]};
  const Pair<double> a{near[0], near[1]}, b{far[0], far[1]};
  const BalancedBeam<double> balanced = balanced_beam<double>(p.rest, chord, a, b, p.axial_stiffness, ei);
  const BeamStiffness<double> h = beam_stiffness<double>(balanced, p.rest, a, b, ei);
  EdgeBeam beam;
  beam.tension = balanced.tension;
  beam.energy = balanced.energy;
  beam.gradient << balanced.tension, balanced.near[0], balanced.near[1], balanced.far[0], balanced.far[1];
  beam.hessian(EdgeBeam::chord, EdgeBeam::chord) = h.chord;
  for (int j = 0; j < 2; ++j) {
    const std::size_t m = base::at(j);
    const int of_near = EdgeBeam::near + j, of_far = EdgeBeam::far + j;
    beam.hessian(EdgeBeam::chord, of_near) = beam.hessian(of_near, EdgeBeam::chord) = h.chord_near[m];
    beam.hessian(EdgeBeam::chord, of_far) = beam.hessian(of_far, EdgeBeam::chord) = h.chord_far[m];
    for (int k = 0; k < 2; ++k) {
      beam.hessian(of_near, EdgeBeam::near + k) = h.near[m][base::at(k)];
      beam.hessian(of_far, EdgeBeam::far + k) = h.far[m][base::at(k)];
      beam.hessian(of_near, EdgeBeam::far + k) = beam.hessian(EdgeBeam::far + k, of_near) =
          h.next[m][base::at(k)];
    }
  }
  return beam;
}

}  // namespace snare::wire
