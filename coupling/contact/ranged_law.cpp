#include "coupling/contact/ranged_law.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace snare::coupling {

namespace {

constexpr int range_samples = 256;  // travels at which a change of sign is looked for

/// The travel between a and b, of forces of different sign, at which the force changes its sign [m].
double sign_change(const SpringLaw& law, double a, double b) {
  const bool negative = law.force(a) < 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (a + b);
    ((law.force(middle) < 0.0) == negative ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

/// Where the law is negative up to a travel [m], by its signs at samples of it.
std::vector<PullingRange> pulling_ranges(const SpringLaw& law, double end) {
  std::vector<PullingRange> ranges;
  double before = 0.0;
  bool negative = law.force(0.0) < 0.0;
  double from = 0.0;
  for (int i = 1; i <= range_samples; ++i) {
    const double d = i == range_samples ? end : end * i / range_samples;
    if ((law.force(d) < 0.0) != negative) {
      const double change = sign_change(law, before, d);
      if (negative) ranges.push_back({from, change});
      from = change;
      negative = !negative;
    }
    before = d;
  }
  if (negative) ranges.push_back({from, end});
  return ranges;
}

}  // namespace

PressingLaw::PressingLaw(SpringLawPointer law, std::vector<PullingRange> pulls)
    : law_(std::move(law)), pulls_(std::move(pulls)) {}

double PressingLaw::force(double d) const {
  const double force = law_->force(d);
  return force < 0.0 ? 0.0 : force;
}

double PressingLaw::stiffness(double d) const {
  return law_->force(d) < 0.0 ? 0.0 : law_->stiffness(d);
}

double PressingLaw::curvature(double d) const {
  return law_->force(d) < 0.0 ? 0.0 : law_->curvature(d);
}

double PressingLaw::energy(double d) const {
  double energy = law_->energy(d);
  for (const PullingRange& pull : pulls_) {
    if (d > pull.from) energy -= law_->energy(std::min(d, pull.to)) - law_->energy(pull.from);
  }
  return energy;
}

RangedLaw::RangedLaw(const SpringLawPointer& law, double end)
    : law_(law, pulling_ranges(*law, end)),
      end_(end),
      end_force_(std::max(0.0, law->force(end))),
      end_stiffness_(std::max(0.0, law->stiffness(end))) {}

double RangedLaw::force(double d) const {
  return d > end_ ? end_force_ + end_stiffness_ * (d - end_) : law_.force(d);
}

double RangedLaw::stiffness(double d) const {
  return d > end_ ? end_stiffness_ : law_.stiffness(d);
}

double RangedLaw::curvature(double d) const {
  return d > end_ ? 0.0 : law_.curvature(d);
}

double RangedLaw::energy(double d) const {
  const double inside = std::min(d, end_), beyond = d - inside;
  return law_.energy(inside) + beyond * (end_force_ + 0.5 * end_stiffness_ * beyond);
}

}  // namespace snare::coupling
