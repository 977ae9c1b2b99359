#include "identification/fitting/replicate_scatter.hpp"

#include "identification/fitting/conditions.hpp"
#include "identification/fitting/prediction.hpp"
#include "numerics/dense_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::identification {

namespace {

constexpr std::size_t most_cells = 40;   // a leg of the path: finer ones say no more of a smooth part
constexpr std::size_t fewest_cells = 4;  // of a condition
constexpr std::size_t a_cell = 2;        // readings, at least on average
constexpr std::size_t few_of_a_leg = 8;  // a leg: of as many every one has its cell

/// Replicates of one condition, averaged over common cells of the path.
struct Cells {
  Eigen::VectorXd path;        // of the cells, along the path [m]
  Eigen::VectorXd force;       // computed, there [N]
  Eigen::VectorXd share;       // of the variance of independent noise that the average has: 1 / readings
  Eigen::MatrixXd deviations;  // from the mean of the replicates, a column each [N]
};

/// Readings of one leg by cells of displacement between `from` and `to`: their sums.
struct Sums {
  std::vector<double> residual, force, count;
};

Sums sums_of(const std::vector<double>& d, const Leg& leg, double from, double to, std::size_t cells,
             const Eigen::VectorXd& residual, const Eigen::VectorXd& computed) {
  Sums sums{std::vector<double>(cells, 0.0), std::vector<double>(cells, 0.0),
            std::vector<double>(cells, 0.0)};
  for (std::size_t i = leg.begin; i < leg.end; ++i) {
    const double u = (d[i] - from) / (to - from);
    if (!(u >= 0.0 && u <= 1.0)) continue;
    const std::size_t c = std::min(cells - 1, static_cast<std::size_t>(u * static_cast<double>(cells)));
    sums.residual[c] += residual[static_cast<Eigen::Index>(i)];
    sums.force[c] += computed[static_cast<Eigen::Index>(i)];
    sums.count[c] += 1.0;
  }
  return sums;
}

/// Averages of a condition; none where too few cells have a reading of every replicate.
std::optional<Cells> cells_of(const std::vector<Series>& series, const std::vector<std::size_t>& group,
                              const std::vector<Eigen::VectorXd>& residuals,
                              const std::vector<Eigen::VectorXd>& computed) {
  std::vector<std::vector<Leg>> legs;
  std::size_t count = std::numeric_limits<std::size_t>::max();
  for (const std::size_t k : group) {
    legs.push_back(legs_of(measured_displacement(series[k])));
    count = std::min(count, legs.back().size());
  }
  const std::size_t replicates = group.size();
  std::vector<double> path, force, share;
  std::vector<std::vector<double>> values;  // a cell, of the replicates
  double travelled = 0.0;
  for (std::size_t leg = 0; leg < count; ++leg) {
    double from = std::numeric_limits<double>::lowest();
    double to = std::numeric_limits<double>::max();
    std::size_t readings = std::numeric_limits<std::size_t>::max();
    for (std::size_t j = 0; j < replicates; ++j) {
      from = std::max(from, legs[j][leg].low);
      to = std::min(to, legs[j][leg].high);
      readings = std::min(readings, legs[j][leg].end - legs[j][leg].begin);
    }
    if (!(to > from)) break;
    // Half a spacing beyond what all have: the end readings of replicates lie that near to each other or are
    // left out.
    const double margin = 0.5 * (to - from) / static_cast<double>(std::max<std::size_t>(readings, 2) - 1);
    from -= margin;
    to += margin;
    const std::size_t few = std::min(readings, few_of_a_leg);
    const std::size_t cells = std::clamp<std::size_t>(std::max(few, readings / a_cell), 1, most_cells);
    const double width = (to - from) / static_cast<double>(cells);
    std::vector<Sums> sums;
    for (std::size_t j = 0; j < replicates; ++j) {
      sums.push_back(sums_of(measured_displacement(series[group[j]]), legs[j][leg], from, to, cells,
                             residuals[group[j]], computed[group[j]]));
    }
    for (std::size_t at = 0; at < cells; ++at) {
      const std::size_t c = legs.front()[leg].up ? at : cells - 1 - at;
      std::vector<double> one;
      double total = 0.0;
      double inverse = 0.0;
      for (const Sums& s : sums) {
        if (s.count[c] == 0.0) break;
        one.push_back(s.residual[c] / s.count[c]);
        total += s.force[c] / s.count[c];
        inverse += 1.0 / s.count[c];
      }
      if (one.size() < replicates) continue;
      path.push_back(travelled + width * (static_cast<double>(at) + 0.5));
      force.push_back(total / static_cast<double>(replicates));
      share.push_back(inverse / static_cast<double>(replicates));
      values.push_back(std::move(one));
    }
    travelled += to - from;
  }
  if (values.size() < fewest_cells) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(values.size());
  Cells result;
  result.path = Eigen::Map<const Eigen::VectorXd>(path.data(), n);
  result.force = Eigen::Map<const Eigen::VectorXd>(force.data(), n);
  result.share = Eigen::Map<const Eigen::VectorXd>(share.data(), n);
  result.deviations.resize(n, static_cast<Eigen::Index>(replicates));
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::vector<double>& one = values[static_cast<std::size_t>(i)];
    const Eigen::Map<const Eigen::RowVectorXd> row(one.data(), static_cast<Eigen::Index>(replicates));
    result.deviations.row(i) = row.array() - row.mean();
  }
  return result;
}

/// Eigenvalues of one condition's smooth covariance against its independent one, and the deviations in their
/// directions.
struct Spectrum {
  Eigen::VectorXd values;
  Eigen::VectorXd squares;  // sums over the replicates
  double replicates = 0.0;
  double logarithms = 0.0;  // of the shares
};

/// With V = w (D + rho M), D the shares: in coordinates D^-1/2 the eigenvalues of D^-1/2 M D^-1/2.
Spectrum spectrum_of(const Cells& cells, double length, double part) {
  const Eigen::Index n = cells.path.size();
  const double largest = std::max(cells.force.cwiseAbs().maxCoeff(), 1e-300);
  const Eigen::ArrayXd f = cells.force.array() / largest;
  // part: of the smooth variance at the largest force that goes with the force.
  const Eigen::VectorXd height = ((1.0 - part) + part * f.square()).sqrt();
  const Eigen::VectorXd scale = cells.share.cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd m(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      m(i, j) = scale[i] * scale[j] * height[i] * height[j] *
                std::exp(-std::abs(cells.path[i] - cells.path[j]) / length);
    }
  }
  const numerics::SymmetricEigen eigen = numerics::symmetric_eigen(m);
  Spectrum s;
  s.values = eigen.values.cwiseMax(0.0);
  s.squares = (eigen.vectors.transpose() * scale.asDiagonal() * cells.deviations).rowwise().squaredNorm();
  s.replicates = static_cast<double>(cells.deviations.cols());
  s.logarithms = cells.share.array().log().sum();
  return s;
}

/// One point of the search.
struct Candidate {
  double criterion = std::numeric_limits<double>::max();  // -2 log of the restricted likelihood
  double white = 0.0;                                     // variance [N^2]
  double ratio = 0.0;                                     // of the smooth variance to it
};

// Of R replicates whose mean is free R - 1 independent draws of N(0, V) are left; the roughness is one more
// witness of w.
//   sum_c (R_c - 1) log|V_c| + tr(V_c^-1 S_c) + nu (log w + w_rough / w),  w in closed form for every ratio
Candidate at_ratio(const std::vector<Spectrum>& spectra, const Roughness& roughness, double ratio) {
  double squares = roughness.dof * roughness.variance;
  double count = roughness.dof;
  double logarithms = 0.0;
  for (const Spectrum& s : spectra) {
    const Eigen::ArrayXd lambda = 1.0 + ratio * s.values.array();
    squares += (s.squares.array() / lambda).sum();
    count += (s.replicates - 1.0) * static_cast<double>(s.values.size());
    logarithms += (s.replicates - 1.0) * (lambda.log().sum() + s.logarithms);
  }
  const double white = std::max(squares / count, 1e-300);
  return {count * std::log(white) + logarithms, white, ratio};
}

Candidate best_ratio(const std::vector<Spectrum>& spectra, const Roughness& roughness) {
  Candidate best;
  for (int tenth = -40; tenth <= 60; ++tenth) {
    const Candidate c = at_ratio(spectra, roughness, std::pow(10.0, 0.1 * tenth));
    if (c.criterion < best.criterion) best = c;
  }
  return best;
}

}  // namespace

Roughness roughness_of(const std::vector<Eigen::VectorXd>& residuals) {
  double sum = 0.0;
  double count = 0.0;
  for (const Eigen::VectorXd& r : residuals) {
    for (Eigen::Index i = 1; i + 1 < r.size(); ++i) {
      const double bend = r[i - 1] - 2.0 * r[i] + r[i + 1];
      sum += bend * bend / 6.0;
      count += 1.0;
    }
  }
  if (count == 0.0) return {};
  return {sum / count, 18.0 * count / 35.0};
}

std::vector<double> ReplicateScatter::heights(const Eigen::VectorXd& computed) const {
  std::vector<double> result;
  for (const double f : computed) result.push_back(std::hypot(height, share * f));
  return result;
}

std::optional<ReplicateScatter> replicate_scatter(const std::vector<Series>& series,
                                                  const std::vector<Eigen::VectorXd>& residuals,
                                                  const std::vector<Eigen::VectorXd>& computed,
                                                  const Roughness& roughness) {
  std::vector<Cells> all;
  double longest = 0.0;
  double largest = 0.0;
  for (const std::vector<std::size_t>& group : conditions(series)) {
    if (group.size() < 2) continue;
    if (auto cells = cells_of(series, group, residuals, computed)) {
      longest = std::max(longest, cells->path.maxCoeff());
      largest = std::max(largest, cells->force.cwiseAbs().maxCoeff());
      all.push_back(std::move(*cells));
    }
  }
  if (all.empty()) return std::nullopt;
  // Without a smooth part.
  std::vector<Spectrum> none;
  double count = roughness.dof;
  for (const Cells& cells : all) {
    none.push_back(spectrum_of(cells, longest, 0.0));
    count += static_cast<double>(cells.path.size() * (cells.deviations.cols() - 1));
  }
  const Candidate plain = at_ratio(none, roughness, 0.0);
  if (!(plain.white > 1e-300)) return std::nullopt;
  ReplicateScatter result{.white = std::sqrt(plain.white), .dof = count};
  constexpr double worthwhile = 6.0;  // of -2 log likelihood: three more numbers
  double best = plain.criterion - worthwhile;
  for (const double length : {0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 3.0}) {
    for (const double part : {0.0, 0.5, 0.9, 1.0}) {
      std::vector<Spectrum> spectra;
      for (const Cells& cells : all) spectra.push_back(spectrum_of(cells, length * longest, part));
      const Candidate c = best_ratio(spectra, roughness);
      if (!(c.criterion < best)) continue;
      best = c.criterion;
      const double smooth = c.white * c.ratio;
      result.white = std::sqrt(c.white);
      result.length = length * longest;
      result.height = std::sqrt((1.0 - part) * smooth);
      result.share = std::sqrt(part * smooth) / largest;
      // As many independent witnesses as the smooth part has directions, one replicate less.
      result.dof = 0.0;
      for (const Spectrum& s : spectra) {
        const double directions = std::pow(s.values.sum(), 2) / s.values.squaredNorm();
        result.dof += (s.replicates - 1.0) * directions;
      }
    }
  }
  return result;
}

}  // namespace snare::identification
