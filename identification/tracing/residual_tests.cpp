#include "identification/tracing/residual_tests.hpp"

#include "identification/fitting/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

bool ResidualTests::acceptable() const {
  constexpr double level = 0.002;
  if (against_replicates) return lack_of_fit > level;
  return 3.0 * std::min({runs, ljung_box, lack_of_fit}) > level;
}

ResidualTests test_residuals(const Data& data, const Fit& fit) {
  std::vector<Eigen::VectorXd> pieces;
  Eigen::Index row = 0;
  for (const std::size_t k : data.series) {
    pieces.emplace_back(fit.residual.segment(row, data.measured[k].size()));
    row += data.measured[k].size();
  }
  ResidualTests tests;
  tests.against_replicates = data.noise.source == "replicates";
  tests.runs = runs_p(pieces);
  tests.ljung_box = ljung_box_p(pieces, 10);
  if (data.noise.source == "residual") {
    // Against the noise of the same readings from second differences, whose own relative variance is 35/(18 n).
    const double n = static_cast<double>(fit.residual.size());
    const double ratio = fit.chi2 / std::max(1.0, fit.dof());
    tests.lack_of_fit = normal_tail((ratio - 1.0) / std::sqrt(2.0 / n + 35.0 / (18.0 * n)));
  } else {
    tests.lack_of_fit = chi_square_tail(fit.chi2, std::max(1.0, fit.dof()));
  }
  return tests;
}

}  // namespace snare::identification
