#include "identification/ring_down/oscillations.hpp"

#include <cmath>

namespace snare::identification {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The envelope  e = max(0, exp(-s t) - g (1 - exp(-s t))/s)  and its derivatives by s and g.
struct Envelope {
  double value = 0.0, by_decay = 0.0, by_friction = 0.0;
};

Envelope envelope(double s, double g, double t) {
  const double decayed = std::exp(-s * t);
  // (1 - exp(-s t))/s and its derivative by s, by their series where s t is small.
  const double x = s * t;
  double lost = t;
  double lost_by_s = -0.5 * t * t;
  if (std::abs(x) > 1e-4) {
    lost = -std::expm1(-x) / s;
    lost_by_s = (t * decayed - lost) / s;
  } else {
    lost *= 1.0 - x / 2.0 + x * x / 6.0;
    lost_by_s *= 1.0 - 2.0 * x / 3.0 + x * x / 4.0;
  }
  const double value = decayed - g * lost;
  if (value <= 0.0) return {};
  return {value, -t * decayed - g * lost_by_s, -lost};
}

}  // namespace

VectorXd oscillations(const OscillationLayout& layout, const VectorXd& p, const VectorXd& time,
                      MatrixXd* by) {
  VectorXd values = VectorXd::Constant(time.size(), p[0]);
  if (by != nullptr) {
    by->setZero(time.size(), layout.size());
    by->col(0).setOnes();
  }
  for (Index m = 0; m < layout.modes; ++m) {
    const double C = p[layout.cosine(m)];
    const double S = p[layout.sine(m)];
    const double w = p[layout.frequency(m)];
    const double g = m == layout.rubbing ? p[layout.friction()] : 0.0;
    for (Index i = 0; i < time.size(); ++i) {
      const double t = time[i];
      const Envelope e = envelope(p[layout.decay(m)], g, t);
      const double c = std::cos(w * t);
      const double s = std::sin(w * t);
      const double swing = C * c + S * s;
      values[i] += e.value * swing;
      if (by == nullptr) continue;
      (*by)(i, layout.cosine(m)) = e.value * c;
      (*by)(i, layout.sine(m)) = e.value * s;
      (*by)(i, layout.frequency(m)) = e.value * t * (S * c - C * s);
      (*by)(i, layout.decay(m)) = e.by_decay * swing;
      if (m == layout.rubbing) (*by)(i, layout.friction()) = e.by_friction * swing;
    }
  }
  return values;
}

}  // namespace snare::identification
