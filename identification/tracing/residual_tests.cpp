#include "identification/tracing/residual_tests.hpp"

#include "identification/fitting/statistics.hpp"
#include "identification/tracing/model_error.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

double ResidualTests::p() const {
  if (of_published || against_replicates) return lack_of_fit;
  return std::min(1.0, 3.0 * std::min({runs, ljung_box, lack_of_fit}));
}

bool ResidualTests::like_noise() const {
  constexpr double level = 0.002;
  return p() > (of_published ? least_published_p : level);
}

ResidualTests test_residuals(const Model& model, const Data& data, const Fit& fit) {
  std::vector<Eigen::VectorXd> pieces;
  Eigen::Index row = 0;
  for (const std::size_t k : data.series) {
    pieces.emplace_back(fit.residual.segment(row, data.rows_of(k)));
    row += data.rows_of(k);
  }
  ResidualTests tests;
  tests.against_replicates = data.noise.source == "replicates";
  tests.runs = runs_p(pieces);
  tests.ljung_box = ljung_box_p(pieces, 10);
  tests.rmse = fitted_rmse(data, fit.evaluation);
  tests.noise = data.noise.mean_sigma(model.series());
  tests.left = remainder(model, data, fit);
  tests.of_published = data.published();
  if (tests.of_published) {
    tests.published =
        summary_statistics(model, data.series, fit.settings, fit.free, {.scatter = data.noise.scatter});
    tests.lack_of_fit = tests.published->p;
    return tests;
  }
  // Replicates say how much their mean may be off; of the noise from second differences its own degrees of
  // freedom.
  const double dof = std::max(1.0, fit.dof());
  tests.lack_of_fit =
      tests.against_replicates ? tests.left.p : fisher_tail(fit.chi2 / dof, dof, data.noise.dof);
  return tests;
}

}  // namespace snare::identification
