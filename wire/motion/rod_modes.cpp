#include "wire/motion/rod_modes.hpp"

#include "numerics/dense_solvers.hpp"
#include "wire/motion/rod_part.hpp"

#include <cassert>
#include <cmath>

namespace snare::wire {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Power that the damping takes at the velocities of a mode [W].
double lost_power(RodInMotion rod, const RodDamping& damping, const Eigen::Matrix3Xd& rest,
                  const Eigen::Matrix3Xd& shape, const VectorXd& turning) {
  rod.damping = damping;
  rod.strands = {};
  RodPart part("wire", rod, {});
  const numerics::DaeSystem system({&part});
  VectorXd y = VectorXd::Zero(system.size());
  VectorXd rate = y;
  part.place(rest, shape, y);
  for (int i = 0; i < part.vertices(); ++i) rate[part.angle_of(i)] = turning[i];
  return part.energies({0.0, y, rate}).dissipation;
}

}  // namespace

std::vector<RodMode> rod_modes(const RodInMotion& rod, const Eigen::Matrix3Xd& rest, int count) {
  // The stiffness is the Jacobian of RodPart without rates and damping; what of it moves, and what follows.
  RodInMotion undamped = rod;
  undamped.damping = {};
  undamped.strands = {};
  RodPart part("wire", undamped, {});
  const RodModel& model = part.model();
  const int n = part.vertices();
  assert(rest.cols() == n);
  numerics::DaeSystem system({&part});
  VectorXd y = VectorXd::Zero(system.size());
  const VectorXd standing = y;
  part.place(rest, {}, y);
  const numerics::SparseMatrix& tangent = system.jacobian({0.0, y, standing}, 0.0);
  struct Row {
    int balance, unknown;
  };
  std::vector<int> moving;
  std::vector<int> turning;
  std::vector<Row> moving_rows, following;
  const bool twist_free = !rod.properties.left.orients() && !rod.properties.right.orients();
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (part.is_held(i, k)) continue;
      moving.push_back(SpatialRod::block * i + k);
      moving_rows.push_back({part.velocity_of(i) + k, part.position_of(i) + k});
    }
    if (i + 1 < n && !(twist_free && i == 0)) {
      turning.push_back(i);
      following.push_back({part.angle_of(i), part.angle_of(i)});
    }
  }
  for (int i = 0; model.is_curved() && i < n; ++i) {
    for (int k = model.curvature_of(i); k < model.curvature_of(i) + 2; ++k) following.push_back({k, k});
  }
  const auto entries = [&](const std::vector<Row>& rows, const std::vector<Row>& columns) {
    MatrixXd m(rows.size(), columns.size());
    for (std::size_t a = 0; a < rows.size(); ++a) {
      for (std::size_t b = 0; b < columns.size(); ++b) {
        const int slot = tangent.slot(rows[a].balance, columns[b].unknown);
        m(static_cast<Index>(a), static_cast<Index>(b)) = slot < 0 ? 0.0 : tangent.value[base::at(slot)];
      }
    }
    return m;
  };
  // dE/dtheta = 0 and dE/dk = 0 along: of these unknowns f, df = -K_ff^-1 K_fx dx.
  const MatrixXd follow =
      -numerics::solve_by_lu(entries(following, following), entries(following, moving_rows));
  MatrixXd stiffness = entries(moving_rows, moving_rows) + entries(moving_rows, following) * follow;
  VectorXd root_mass(static_cast<Index>(moving.size()));
  for (std::size_t a = 0; a < moving.size(); ++a)
    root_mass[static_cast<Index>(a)] = std::sqrt(part.mass_of(moving[a] / SpatialRod::block));
  stiffness = root_mass.cwiseInverse().asDiagonal() * stiffness * root_mass.cwiseInverse().asDiagonal();
  const numerics::SymmetricEigen eigen = numerics::symmetric_eigen(0.5 * (stiffness + stiffness.transpose()));
  const VectorXd& squares = eigen.values;
  std::vector<RodMode> modes;
  constexpr double round_off = 1e-12;
  for (Index m = 0; m < squares.size() && static_cast<int>(modes.size()) < count; ++m) {
    if (squares[m] <= round_off * squares[squares.size() - 1]) continue;
    VectorXd x = root_mass.cwiseInverse().cwiseProduct(eigen.vectors.col(m));
    const double scale = x.cwiseAbs().maxCoeff();
    x /= scale;
    RodMode mode;
    mode.natural = std::sqrt(squares[m]);
    mode.shape = Eigen::Matrix3Xd::Zero(3, n);
    for (std::size_t a = 0; a < moving.size(); ++a)
      mode.shape(moving[a] % SpatialRod::block, moving[a] / SpatialRod::block) = x[static_cast<Index>(a)];
    const VectorXd turns = follow * x;
    VectorXd rates = VectorXd::Zero(n);
    for (std::size_t a = 0; a < turning.size(); ++a) rates[turning[a]] = turns[static_cast<Index>(a)];
    // phi^T M phi = 1/scale^2.
    const double whole = squares[m] / (scale * scale);
    mode.bending_share = lost_power(rod, {1.0, 0.0, 0.0}, rest, mode.shape, rates) / whole;
    mode.axial_share = lost_power(rod, {0.0, 1.0, 0.0}, rest, mode.shape, rates) / whole;
    modes.push_back(std::move(mode));
  }
  return modes;
}

}  // namespace snare::wire
