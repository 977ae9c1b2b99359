#include "coupling/dynamics/model/modes.hpp"

#include "base/index.hpp"
#include "coupling/dynamics/run/run.hpp"
#include "multibody/dynamics.hpp"
#include "numerics/klu.hpp"
#include "numerics/sparse_eigen.hpp"
#include "numerics/sparse_matrix.hpp"

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

/// Twice the kinetic energy of rates about a pose, by joint with its motor; what moves no elastic joint is
/// the base.
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

namespace {

/// A x + B x' = 0 with one pattern, columns scaled by the tolerances, the sizes at which unknowns of
/// different units are alike.
struct Pencil {
  numerics::SparseMatrix A, B;
};

constexpr double shift = 0.9173;  // [1/s]: no eigenvalue of note

/// Eigenvalues mu of (A + s B)^-1 B with their vectors: all of them, or of a large pencil those of the
/// slowest motions.
numerics::GeneralEigen shifted_eigenvalues(const Pencil& pencil) {
  numerics::SparseMatrix shifted = pencil.A, B = pencil.B;
  for (std::size_t k = 0; k < B.value.size(); ++k) shifted.value[k] += shift * B.value[k];
  const VectorXd rows = numerics::largest_of_rows(shifted).cwiseInverse();
  if (!rows.allFinite()) return {};
  for (numerics::SparseMatrix* m : {&shifted, &B}) numerics::scale(*m, rows, VectorXd::Ones(rows.size()));
  if (B.order <= most_unknowns_of_all_modes) {
    const MatrixXd M = Eigen::FullPivLU<MatrixXd>(numerics::dense(shifted)).solve(numerics::dense(B));
    return M.allFinite() ? numerics::general_eigen(M) : numerics::GeneralEigen{};
  }
  numerics::Klu factors(shifted);
  if (!factors.factorize(shifted)) return {};
  const auto apply = [&](const MatrixXd& X) {
    MatrixXd Y(X.rows(), X.cols());
    for (Index k = 0; k < X.cols(); ++k) {
      Y.col(k) = numerics::product(B, VectorXd(X.col(k)));
      factors.solve(Y.col(k));
    }
    return Y;
  };
  return numerics::largest_eigenvalues(apply, B.order, slowest_eigenvalues);
}

}  // namespace

// F(y + x, y' + x') = 0 to first order: A x + B x' = 0. With M = (A + s B)^-1 B and M x = mu x it is lambda =
// s - 1/mu; what no rate acts on has mu = 0.
SmallMotions MotionRun::small_motions() {
  // Of the rates in the second matrix [1/s]: lifts them out of the round-off of the first.
  constexpr double weight = 1e3;
  const numerics::DaePoint now{time_, y_, rate_};
  leave_plane();
  VectorXd size(system_->size());
  for (const numerics::DaeBlock& block : system_->layout().blocks())
    size.segment(block.first, block.count).setConstant(block.absolute_tolerance);
  Pencil pencil{system_->jacobian(now, 0.0), system_->jacobian(now, weight)};
  for (std::size_t k = 0; k < pencil.A.value.size(); ++k)
    pencil.B.value[k] = (pencil.B.value[k] - pencil.A.value[k]) / weight;
  for (numerics::SparseMatrix* m : {&pencil.A, &pencil.B})
    numerics::scale(*m, VectorXd::Ones(size.size()), size);
  const numerics::GeneralEigen found = shifted_eigenvalues(pencil);
  // Largest coefficients of an equation.
  const VectorXd of_A = numerics::largest_of_rows(pencil.A), of_B = numerics::largest_of_rows(pencil.B);
  SmallMotions small;
  double fastest = 0.0;
  for (Index k = 0; k < found.values.size(); ++k) {
    const std::complex<double> mu = found.values[k];
    if (std::abs(mu) == 0.0) continue;
    const std::complex<double> lambda = shift - 1.0 / mu;
    if (lambda.imag() < 0.0 || !(std::abs(lambda) > slowest) || !std::isfinite(std::abs(lambda))) continue;
    const VectorXcd x = found.vectors.col(k);
    // What constraints make of mu = 0 in round-off is no solution of the equations themselves.
    const VectorXd rest =
        (numerics::product(pencil.A, x) + lambda * numerics::product(pencil.B, x)).cwiseAbs();
    const VectorXd largest = (of_A + std::abs(lambda) * of_B) * x.cwiseAbs().maxCoeff();
    if (!(rest.array() <= trusted * largest.array()).all()) continue;
    fastest = std::max(fastest, std::abs(lambda));
    if (lambda.imag() <= slowest) continue;
    const VectorXcd unscaled = size.asDiagonal() * x;
    small.modes.push_back({std::abs(lambda) / (2.0 * std::numbers::pi), -lambda.real() / std::abs(lambda),
                           shares_of(unscaled), shape_of(unscaled), std::nullopt});
  }
  if (size.size() <= most_unknowns_of_all_modes) small.fastest = fastest;
  std::ranges::sort(small.modes, {}, &MotionMode::frequency);
  return small;
}

ModeShape MotionRun::shape_of(const VectorXcd& x) {
  std::vector<std::complex<double>> coordinates;
  const auto add = [&](std::complex<double> velocity, double mass) {
    coordinates.push_back(std::sqrt(mass) * velocity);
  };
  for (const BodyPart& b : bodies_) {
    if (!b.moves_freely()) continue;
    const multibody::RigidBodyProperties& body = b.body().properties;
    for (int i = 0; i < 3; ++i) {
      add(x[b.velocity() + i], body.mass);
      add(x[b.spin() + i], body.inertia(i, i));
    }
  }
  for (std::size_t a = 0; a < motion_.arms.size(); ++a) {
    const multibody::ElasticArm& arm = motion_.arms[a].arm;
    const multibody::ElasticArmPart& part = constraints_->arm(static_cast<int>(a));
    multibody::DynamicsWorkspace workspace(arm.tree);
    const VectorXd mass = multibody::mass_matrix(arm.tree, part.state(y_).q, workspace).diagonal();
    const multibody::ArmState real = part.state(x.real()), imaginary = part.state(x.imag());
    for (Index i = 0; i < mass.size(); ++i) add({real.v[i], imaginary.v[i]}, mass[i]);
    for (int j = 0; j < arm.motors(); ++j)
      add({real.motor_rate[j], imaginary.motor_rate[j]}, arm.joints[at(j)].motor_inertia);
  }
  ModeShape shape;
  shape.bodies_and_arms =
      Eigen::Map<const VectorXcd>(coordinates.data(), static_cast<Index>(coordinates.size()));
  for (std::size_t w = 0; w < rods_.size(); ++w) {
    Eigen::Matrix3Xcd& wire = shape.wires.emplace_back();
    if (motion_.wires[w].rod.quasi_static) continue;
    double mass = 0.0;
    for (int i = 0; i < rods_[w].vertices(); ++i) mass += rods_[w].mass_of(i);
    wire.resize(3, rods_[w].vertices());
    for (int i = 0; i < rods_[w].vertices(); ++i)
      wire.col(i) = std::sqrt(mass / rods_[w].vertices()) * x.segment<3>(rods_[w].velocity_of(i));
  }
  return shape;
}

// The kinetic energy is quadratic in the velocities: of an oscillation the sum of those of the real and of
// the imaginary part.
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
        energy[motion_.bodies[k].name + " shift " + axes[at(i)]] +=
            b.body().properties.mass * shift[i] * shift[i];
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
        energy[motion_.wires[w].name] +=
            rods_[w].mass_of(i) * v.segment<3>(rods_[w].velocity_of(i)).squaredNorm();
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

SmallMotions small_motions_at(const Motion& motion, const MotionOptions& options, const MotionState& state) {
  const MotionObserver none;
  MotionRun run(motion, options, none);
  run.resume(state);
  return run.small_motions();
}

}  // namespace snare::coupling
