#include "multibody/deflection_law.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace snare::multibody {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}
double sign(int branch) {
  return branch < 0 ? -1.0 : 1.0;
}

}  // namespace

DeflectionLaw::DeflectionLaw(std::vector<DeflectionPiece> pieces, StiffnessReading reading,
                             DampingRate damping_rate)
    : pieces_(std::move(pieces)), reading_(reading), damping_rate_(damping_rate) {
  if (pieces_.empty() || pieces_.front().from != 0.0)
    throw std::invalid_argument("the first piece must begin at 0");
  double torque = 0.0, energy = 0.0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const DeflectionPiece& now = pieces_[i];
    if (!(now.stiffness >= 0.0) || !(now.damping >= 0.0))
      throw std::invalid_argument("stiffness and damping must be >= 0");
    if (i > 0) {
      const DeflectionPiece& before = pieces_[i - 1];
      const double length = now.from - before.from;
      if (!(length > 0.0)) throw std::invalid_argument("the pieces must begin one after another");
      energy += (torque + 0.5 * before.stiffness * length) * length;
      torque += before.stiffness * length;
    }
    if (reading_ == StiffnessReading::literal) torque = now.stiffness * now.from;
    torque_from_.push_back(torque);
    energy_from_.push_back(energy);
  }
}

DeflectionLaw DeflectionLaw::linear(double stiffness, double damping) {
  return DeflectionLaw({{0.0, stiffness, damping}});
}

DeflectionLaw DeflectionLaw::backlash(double half_gap, double stiffness, double damping) {
  return DeflectionLaw({{0.0, 0.0, 0.0}, {half_gap, stiffness, damping}});
}

const DeflectionPiece& DeflectionLaw::piece(int branch) const {
  return pieces_[at(std::abs(branch))];
}

int DeflectionLaw::branch_of(double deflection) const {
  int i = static_cast<int>(pieces_.size()) - 1;
  while (i > 0 && std::abs(deflection) < pieces_[at(i)].from) --i;
  return deflection < 0.0 ? -i : i;
}

bool DeflectionLaw::outermost(int branch) const {
  return std::abs(branch) + 1 == static_cast<int>(pieces_.size());
}

double DeflectionLaw::lower_end(int branch) const {
  if (branch > 0) return piece(branch).from;
  return outermost(branch) ? -std::numeric_limits<double>::infinity()
                           : -pieces_[at(std::abs(branch) + 1)].from;
}

double DeflectionLaw::upper_end(int branch) const {
  return -lower_end(-branch);
}

double DeflectionLaw::torque(int branch, double deflection) const {
  const DeflectionPiece& p = piece(branch);
  return sign(branch) * torque_from_[at(std::abs(branch))] +
         p.stiffness * (deflection - sign(branch) * p.from);
}

double DeflectionLaw::stiffness(int branch) const {
  return piece(branch).stiffness;
}
double DeflectionLaw::damping(int branch) const {
  return piece(branch).damping;
}

double DeflectionLaw::energy(int branch, double deflection) const {
  const DeflectionPiece& p = piece(branch);
  const double beyond = sign(branch) * deflection - p.from;
  return energy_from_[at(std::abs(branch))] +
         (torque_from_[at(std::abs(branch))] + 0.5 * p.stiffness * beyond) * beyond;
}

}  // namespace snare::multibody
