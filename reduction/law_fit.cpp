#include "reduction/law_fit.hpp"

#include "numerics/dense_solvers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace snare::reduction {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Points {
  std::vector<double> travel, force;
};

VectorXd misfit(const coupling::LawForm& form, const VectorXd& p, const Points& points) {
  VectorXd r(static_cast<Eigen::Index>(points.travel.size()));
  for (std::size_t i = 0; i < points.travel.size(); ++i)
    r[static_cast<Eigen::Index>(i)] = form.force(p, points.travel[i]) - points.force[i];
  return r;
}

MatrixXd jacobian(const coupling::LawForm& form, const VectorXd& p, const Points& points) {
  MatrixXd j(static_cast<Eigen::Index>(points.travel.size()), p.size());
  for (std::size_t i = 0; i < points.travel.size(); ++i)
    j.row(static_cast<Eigen::Index>(i)) = form.by_parameters(p, points.travel[i]).transpose();
  return j;
}

/// Levenberg and Marquardt with Marquardt's scaling. Linear forms arrive in two steps.
bool minimise(const coupling::LawForm& form, const Points& points, VectorXd& p) {
  double damping = 1e-6;
  VectorXd r = misfit(form, p, points);
  for (int iteration = 0; iteration < 200; ++iteration) {
    const MatrixXd j = jacobian(form, p, points);
    const VectorXd gradient = j.transpose() * r;
    VectorXd scale = j.colwise().norm();
    for (Eigen::Index i = 0; i < scale.size(); ++i) scale[i] = scale[i] > 0.0 ? scale[i] : 1.0;
    // Columns at right angles to the misfit: done.
    if ((gradient.cwiseQuotient(scale)).lpNorm<Eigen::Infinity>() <= 1e-12 * (r.norm() + 1e-300)) return true;
    bool moved = false;
    for (int k = 0; k < 30 && !moved; ++k, damping *= 8.0) {
      MatrixXd stacked(j.rows() + p.size(), p.size());
      stacked << j * scale.cwiseInverse().asDiagonal(),
          std::sqrt(damping) * MatrixXd::Identity(p.size(), p.size());
      VectorXd right = VectorXd::Zero(stacked.rows());
      right.head(r.size()) = -r;
      const VectorXd step = numerics::full_rank_least_squares(stacked, right).cwiseQuotient(scale);
      const VectorXd next = p + step;
      if (!form.admissible(next)) continue;
      const VectorXd r_next = misfit(form, next, points);
      if (!r_next.allFinite() || !(r_next.norm() <= r.norm())) continue;
      moved = true;
      const bool still = r.norm() - r_next.norm() <= 1e-14 * r.norm() &&
                         step.cwiseProduct(scale).norm() <= 1e-12 * (j * p).norm();
      p = next;
      r = r_next;
      if (still) return true;
    }
    damping = std::max(1e-15, damping * 1e-3);
    if (!moved) return true;  // at the bottom to round-off, or at the edge of what is admissible
  }
  return false;
}

}  // namespace

coupling::LawValue FittedLaw::at(double travel, coupling::Outside outside) const {
  coupling::LawValue result;
  if (travel < 0.0) return result;
  result.extrapolated = !range.contains(travel);
  if (result.extrapolated && outside == coupling::Outside::refuse) {
    throw std::domain_error(
        fmt::format("travel of {:.6g} mm is outside the range of the law {}, {:.6g} to {:.6g} mm",
                    1e3 * travel, form->name(), 1e3 * range.low, 1e3 * range.high));
  }
  const coupling::RangedLaw law = ranged();
  result.force = law.force(travel);
  result.stiffness = law.stiffness(travel);
  return result;
}

double FittedLaw::energy(double travel) const {
  return travel <= 0.0 ? 0.0 : ranged().energy(travel);
}

LawError error_of(const numerics::HermiteCurve& curve, const std::vector<std::size_t>& at,
                  const FittedLaw& law) {
  LawError e;
  const coupling::RangedLaw ranged = law.ranged();
  Interval force, stiffness, energy;
  bool first = true;
  const auto widen = [&](Interval& range, double x) {
    range = first ? Interval{x, x} : Interval{std::min(range.low, x), std::max(range.high, x)};
  };
  double sum_f = 0.0;
  double sum_k = 0.0;
  double sum_e = 0.0;
  for (const std::size_t i : at) {
    const double d = curve.knots()[i];
    const double off_f = std::abs(ranged.force(d) - curve.value(d));
    const double off_k = std::abs(ranged.stiffness(d) - curve.slope(d));
    const double off_e = std::abs(ranged.energy(d) - curve.integral(d));
    widen(force, curve.value(d));
    widen(stiffness, curve.slope(d));
    widen(energy, curve.integral(d));
    first = false;
    e.largest_force = std::max(e.largest_force, off_f);
    e.largest_stiffness = std::max(e.largest_stiffness, off_k);
    e.largest_energy = std::max(e.largest_energy, off_e);
    sum_f += off_f * off_f;
    sum_k += off_k * off_k;
    sum_e += off_e * off_e;
  }
  e.points = at.size();
  if (e.points == 0) return e;
  const double n = static_cast<double>(e.points);
  e.rms_force = std::sqrt(sum_f / n);
  e.rms_stiffness = std::sqrt(sum_k / n);
  e.rms_energy = std::sqrt(sum_e / n);
  e.force_range = force.high - force.low;
  e.stiffness_range = stiffness.high - stiffness.low;
  e.energy_range = energy.high - energy.low;
  return e;
}

FittedLaw fit_law(const coupling::LawFormPointer& form, const numerics::HermiteCurve& curve,
                  const std::vector<std::size_t>& fit_at) {
  FittedLaw law;
  law.form = form;
  law.range = {curve.knots().front(), curve.knots().back()};
  Points points;
  double largest = 0.0;
  for (const std::size_t i : fit_at) {
    points.travel.push_back(curve.knots()[i]);
    points.force.push_back(curve.value(curve.knots()[i]));
    largest = std::max(largest, std::abs(points.force.back()));
  }
  double best = std::numeric_limits<double>::infinity();
  for (VectorXd p : form->guesses(largest, law.range.high)) {
    if (!form->admissible(p)) continue;
    const bool converged = minimise(*form, points, p);
    const double norm = misfit(*form, p, points).norm();
    if (!(norm < best)) continue;
    best = norm;
    law.values = p;
    law.converged = converged;
  }
  if (law.values.size() == 0) return law;
  const auto n = static_cast<Eigen::Index>(points.travel.size());
  const double variance = best * best / static_cast<double>(std::max<Eigen::Index>(1, n - law.values.size()));
  const MatrixXd j = jacobian(*form, law.values, points);
  const VectorXd scale = j.colwise().norm().transpose().cwiseMax(1e-300);
  const MatrixXd unit = j * scale.cwiseInverse().asDiagonal();
  const MatrixXd inverse = numerics::pseudo_inverse(unit.transpose() * unit);
  law.covariance =
      variance * (scale.cwiseInverse().asDiagonal() * inverse * scale.cwiseInverse().asDiagonal());
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < curve.knots().size(); ++i) {
    if (!std::binary_search(fit_at.begin(), fit_at.end(), i)) others.push_back(i);
  }
  law.error = error_of(curve, others, law);
  return law;
}

StiffnessCurve stiffness_curve(const numerics::HermiteCurve& curve, int points) {
  StiffnessCurve result;
  const double end = curve.knots().back();
  for (int i = 1; i <= points; ++i) {
    const double d = end * i / points;
    result.travel.push_back(d);
    result.secant.push_back(curve.value(d) / d);
    result.tangent.push_back(curve.slope(d));
  }
  return result;
}

}  // namespace snare::reduction
