#include "coupling/dynamics/modes.hpp"

#include "base/errors.hpp"
#include "base/index.hpp"
#include "coupling/dynamics/run.hpp"
#include "multibody/dynamics.hpp"
#include "numerics/dense_solvers.hpp"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

namespace snare::coupling {

using base::at;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

namespace {

constexpr double slowest = 1e-3;  // [rad/s]: below it are the coordinates that nothing holds
constexpr double smallest_share = 0.01;
constexpr double trusted = 1e-6;  // of the largest term that an equation could have: what may be left of it

/// Twice the kinetic energy of rates about a pose, by joint with its motor; what moves no elastic joint is the base.
void add_arm(const MotionArm& one, const VectorXd& q, const multibody::ArmState& rates,
             std::map<std::string, double>& energy) {
  const multibody::ElasticArm& arm = one.arm;
  std::vector<std::string> names(at(arm.tree.velocities()), one.name + " base");
  for (int j = 0; j < arm.motors(); ++j) {
    const std::string name = one.joint_name(j);
    names[at(arm.tree.body(arm.joints[at(j)].body).v_index)] = name;
    energy[name] += arm.joints[at(j)].motor_inertia * rates.motor_rate[j] * rates.motor_rate[j];
  }
  multibody::DynamicsWorkspace workspace(arm.tree);
  const VectorXd momentum = multibody::mass_matrix(arm.tree, q, workspace) * rates.v;
  for (int i = 0; i < arm.tree.velocities(); ++i) energy[names[at(i)]] += rates.v[i] * momentum[i];
}

}  // namespace

// F(y + x, y' + x') = 0 to first order: A x + B x' = 0. With M = (A + s B)^-1 B and M x = mu x it is lambda = s - 1/mu; what no rate acts on has
// mu = 0. The columns are scaled by the tolerances, the sizes at which unknowns of different units are alike, the rows by their largest entry.
SmallMotions MotionRun::small_motions() {
  constexpr double shift = 0.9173;  // [1/s]: no eigenvalue of note
  // Of the rates in the second matrix [1/s]: lifts them out of the round-off of the first.
  constexpr double weight = 1e3;
  const numerics::DaePoint now{time_, y_, rate_};
  leave_plane();
  const MatrixXd A = numerics::dense(system_->jacobian(now, 0.0));
  const MatrixXd B = (numerics::dense(system_->jacobian(now, weight)) - A) / weight;
  VectorXd size(system_->size());
  for (const numerics::DaeBlock& block : system_->layout().blocks())
    size.segment(block.first, block.count).setConstant(block.absolute_tolerance);
  MatrixXd shifted = (A + shift * B) * size.asDiagonal();
  const VectorXd rows = shifted.cwiseAbs().rowwise().maxCoeff().cwiseInverse();
  if (!rows.allFinite()) return {};
  shifted = rows.asDiagonal() * shifted;
  const MatrixXd M = Eigen::FullPivLU<MatrixXd>(shifted).solve(MatrixXd(rows.asDiagonal() * B * size.asDiagonal()));
  if (!M.allFinite()) return {};
  const numerics::GeneralEigen modes = numerics::general_eigen(M);
  // Largest coefficients of an equation.
  const VectorXd of_A = (A * size.asDiagonal()).cwiseAbs().rowwise().maxCoeff();
  const VectorXd of_B = (B * size.asDiagonal()).cwiseAbs().rowwise().maxCoeff();
  SmallMotions small;
  for (Index k = 0; k < M.cols(); ++k) {
    const std::complex<double> mu = modes.values[k];
    if (std::abs(mu) == 0.0) continue;
    const std::complex<double> lambda = shift - 1.0 / mu;
    if (lambda.imag() < 0.0 || !(std::abs(lambda) > slowest) || !std::isfinite(std::abs(lambda))) continue;
    const VectorXcd x = size.asDiagonal() * modes.vectors.col(k);
    // What constraints make of mu = 0 in round-off is no solution of the equations themselves.
    const VectorXd rest = (A * x + lambda * (B * x)).cwiseAbs();
    const VectorXd largest = (of_A + std::abs(lambda) * of_B) * modes.vectors.col(k).cwiseAbs().maxCoeff();
    if (!(rest.array() <= trusted * largest.array()).all()) continue;
    small.fastest = std::max(small.fastest, std::abs(lambda));
    if (lambda.imag() > slowest)
      small.modes.push_back(
          {std::abs(lambda) / (2.0 * std::numbers::pi), -lambda.real() / std::abs(lambda), shares_of(x)});
  }
  std::ranges::sort(small.modes, {}, &MotionMode::frequency);
  return small;
}

// The kinetic energy is quadratic in the velocities: of an oscillation the sum of those of the real and of the imaginary part.
std::vector<std::pair<std::string, double>> MotionRun::shares_of(const VectorXcd& x) {
  std::map<std::string, double> energy;
  constexpr std::array<const char*, 3> axes{"x", "y", "z"};
  const MatrixXd parts = (MatrixXd(x.size(), 2) << x.real(), x.imag()).finished();
  for (Index part = 0; part < parts.cols(); ++part) {
    const VectorXd v = parts.col(part);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const BodyPart& b = bodies_[k];
      if (!b.moves_freely()) continue;
      const Eigen::Vector3d shift = v.segment<3>(b.velocity()), turn = v.segment<3>(b.spin());
      const Eigen::Vector3d spin = b.body().properties.inertia * turn;
      for (int i = 0; i < 3; ++i) {
        energy[motion_.bodies[k].name + " shift " + axes[at(i)]] += b.body().properties.mass * shift[i] * shift[i];
        energy[motion_.bodies[k].name + " turn " + axes[at(i)]] += turn[i] * spin[i];
      }
    }
    for (std::size_t a = 0; a < motion_.arms.size(); ++a) {
      const multibody::ElasticArmPart& arm = constraints_->arm(static_cast<int>(a));
      add_arm(motion_.arms[a], arm.state(y_).q, arm.state(v), energy);
    }
    for (std::size_t w = 0; w < rods_.size(); ++w) {
      if (motion_.wires[w].rod.quasi_static) continue;
      for (int i = 0; i < rods_[w].vertices(); ++i)
        energy[motion_.wires[w].name] += rods_[w].mass_of(i) * v.segment<3>(rods_[w].velocity_of(i)).squaredNorm();
    }
  }
  double sum = 0.0;
  for (const auto& [name, share] : energy) sum += std::abs(share);
  std::vector<std::pair<std::string, double>> shares;
  for (const auto& [name, share] : energy) {
    if (std::abs(share) >= smallest_share * sum) shares.emplace_back(name, share / sum);
  }
  std::ranges::sort(shares, [](const auto& a, const auto& b) { return a.second > b.second; });
  return shares;
}

int unknowns_of(const Motion& motion, const MotionOptions& options) {
  const MotionObserver none;
  return MotionRun(motion, options, none).unknowns();
}

SmallMotions small_motions_at(const Motion& motion, const MotionOptions& options, const MotionState& state) {
  const MotionObserver none;
  MotionRun run(motion, options, none);
  if (run.unknowns() > most_unknowns_of_modes) {
    throw base::InputError(
        {"", 0, "modes", fmt::format("{} unknowns", run.unknowns()),
         fmt::format("at most {} can be asked for modes: wires of fewer elements, or laws in their place",
                     most_unknowns_of_modes)});
  }
  run.resume(state);
  return run.small_motions();
}

}  // namespace snare::coupling
