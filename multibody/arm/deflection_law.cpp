#include "multibody/arm/deflection_law.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace snare::multibody {

namespace {

using base::at;
double sign(int branch) {
  return branch < 0 ? -1.0 : 1.0;
}

}  // namespace

DeflectionLaw::DeflectionLaw(std::vector<DeflectionPiece> pieces, StiffnessReading reading,
                             DampingRate damping_rate, double jump_width)
    : pieces_(std::move(pieces)), damping_rate_(damping_rate) {
  if (pieces_.empty() || pieces_.front().from != 0.0)
    throw std::invalid_argument("the first piece must begin at 0");
  double torque = 0.0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const DeflectionPiece& now = pieces_[i];
    if (!(now.stiffness >= 0.0) || !(now.damping >= 0.0))
      throw std::invalid_argument("stiffness and damping must be >= 0");
    if (i > 0) {
      const DeflectionPiece& before = pieces_[i - 1];
      const double length = now.from - before.from;
      if (!(length > 0.0)) throw std::invalid_argument("the pieces must begin one after another");
      torque += before.stiffness * length;
    }
    if (reading == StiffnessReading::literal) torque = now.stiffness * now.from;
    torque_from_.push_back(torque);
  }
  if (!(jump_width >= 0.0)) throw std::invalid_argument("the width of the jumps must be >= 0");
  if (jump_width > 0.0) add_ramps(jump_width);
  double energy = 0.0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (i > 0) {
      const DeflectionPiece& before = pieces_[i - 1];
      const double length = pieces_[i].from - before.from;
      energy += (torque_from_[i - 1] + 0.5 * before.stiffness * length) * length;
    }
    energy_from_.push_back(energy);
  }
}

void DeflectionLaw::add_ramps(double width) {
  const std::vector<DeflectionPiece> given = std::move(pieces_);
  const std::vector<double> torque = std::move(torque_from_);
  pieces_ = {given.front()};
  torque_from_ = {torque.front()};
  for (std::size_t i = 1; i < given.size(); ++i) {
    const DeflectionPiece& now = given[i];
    const DeflectionPiece& before = given[i - 1];
    if (!(width < now.from - before.from))
      throw std::invalid_argument("the jumps must be narrower than the pieces");
    const double reached = torque[i - 1] + before.stiffness * (now.from - before.from);
    if (reached == torque[i] && before.damping == now.damping) {
      pieces_.push_back(now);
      torque_from_.push_back(torque[i]);
      continue;
    }
    const double low = reached - 0.5 * before.stiffness * width,
                 high = torque[i] + 0.5 * now.stiffness * width;
    pieces_.push_back({now.from - 0.5 * width, (high - low) / width, before.damping,
                       (now.damping - before.damping) / width});
    torque_from_.push_back(low);
    pieces_.push_back({now.from + 0.5 * width, now.stiffness, now.damping, 0.0});
    torque_from_.push_back(high);
  }
}

DeflectionLaw DeflectionLaw::linear(double stiffness, double damping) {
  return DeflectionLaw({{0.0, stiffness, damping, 0.0}});
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

// Beyond the ends of a ramp, where only trial steps come, the damping stays what it is there.
double DeflectionLaw::damping(int branch, double deflection) const {
  const DeflectionPiece& p = piece(branch);
  if (p.damping_slope == 0.0) return p.damping;
  const double length = pieces_[at(std::abs(branch)) + 1].from - p.from;
  return p.damping + p.damping_slope * std::clamp(sign(branch) * deflection - p.from, 0.0, length);
}

double DeflectionLaw::damping_slope(int branch, double deflection) const {
  const DeflectionPiece& p = piece(branch);
  if (p.damping_slope == 0.0) return 0.0;
  const double beyond = sign(branch) * deflection - p.from;
  const bool inside = beyond >= 0.0 && beyond <= pieces_[at(std::abs(branch)) + 1].from - p.from;
  return inside ? sign(branch) * p.damping_slope : 0.0;
}

double DeflectionLaw::energy(int branch, double deflection) const {
  const DeflectionPiece& p = piece(branch);
  const double beyond = sign(branch) * deflection - p.from;
  return energy_from_[at(std::abs(branch))] +
         (torque_from_[at(std::abs(branch))] + 0.5 * p.stiffness * beyond) * beyond;
}

}  // namespace snare::multibody
