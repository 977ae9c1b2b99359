#include "coupling/contact/ranged_law.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace snare::coupling {

namespace {

constexpr int gap_samples = 256;  // travels at which a change of sign is looked for

/// The travel between a and b, of forces of different sign, at which the force changes its sign [m].
double sign_change(const SpringLaw& law, double a, double b) {
  const bool negative = law.force(a) < 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (a + b);
    ((law.force(middle) < 0.0) == negative ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

}  // namespace

RangedLaw::RangedLaw(SpringLawPointer law, double end)
    : law_(std::move(law)),
      end_(end),
      end_force_(std::max(0.0, law_->force(end))),
      end_stiffness_(std::max(0.0, law_->stiffness(end))) {
  double before = 0.0;
  bool negative = law_->force(0.0) < 0.0;
  double from = 0.0;
  for (int i = 1; i <= gap_samples; ++i) {
    const double d = i == gap_samples ? end : end * i / gap_samples;
    if ((law_->force(d) < 0.0) != negative) {
      const double change = sign_change(*law_, before, d);
      if (negative) gaps_.push_back({from, change});
      from = change;
      negative = !negative;
    }
    before = d;
  }
  if (negative) gaps_.push_back({from, end});
}

double RangedLaw::force(double d) const {
  if (d > end_) return end_force_ + end_stiffness_ * (d - end_);
  const double force = law_->force(d);
  return force < 0.0 ? 0.0 : force;
}

double RangedLaw::stiffness(double d) const {
  if (d > end_) return end_stiffness_;
  return law_->force(d) < 0.0 ? 0.0 : law_->stiffness(d);
}

double RangedLaw::energy(double d) const {
  const double inside = std::min(d, end_);
  double energy = law_->energy(inside);
  for (const Gap& gap : gaps_) {
    if (inside > gap.from) energy -= law_->energy(std::min(inside, gap.to)) - law_->energy(gap.from);
  }
  const double beyond = d - inside;
  return energy + beyond * (end_force_ + 0.5 * end_stiffness_ * beyond);
}

}  // namespace snare::coupling
