#include "tests/support/derivatives.hpp"

#include <cmath>
#include <limits>
#include <sstream>

namespace snare::test {

namespace {

using Function = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

// (8 (f(+h) - f(-h)) - (f(+2h) - f(-2h)))/(12 h), error h^4 f^(5)/30.
Eigen::MatrixXd differences(const Function& f, const Eigen::VectorXd& x, Eigen::Index rows, double h) {
  Eigen::MatrixXd jacobian(rows, x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const auto at = [&](double step) {
      Eigen::VectorXd moved = x;
      moved[j] += step;
      return f(moved);
    };
    jacobian.col(j) = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
  }
  return jacobian;
}

enum class Part { whole, symmetric };

DerivativeError sweep(const Function& f, const Eigen::VectorXd& x, const Eigen::MatrixXd& analytic,
                      double scale, Part part) {
  DerivativeError best;
  best.relative = std::numeric_limits<double>::infinity();
  const double size = std::max(analytic.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  for (int i = 0; i <= 8; ++i) {
    const double step = 1e-1 * std::pow(0.1, 0.5 * i);
    Eigen::MatrixXd numeric = differences(f, x, analytic.rows(), step * scale);
    if (part == Part::symmetric) numeric = (0.5 * (numeric + numeric.transpose())).eval();
    Eigen::Index row = 0;
    Eigen::Index column = 0;
    const double error = (numeric - analytic).cwiseAbs().maxCoeff(&row, &column) / size;
    if (!(error < best.relative)) continue;
    best.relative = error;
    best.step = step * scale;
    std::ostringstream text;
    text.precision(15);
    text << "entry (" << row << ", " << column << "): analytic " << analytic(row, column) << ", difference "
         << numeric(row, column) << ", step " << best.step << ", relative to the largest entry " << error;
    best.worst = text.str();
  }
  return best;
}

}  // namespace

DerivativeError compare_jacobian(const Function& f, const Eigen::VectorXd& x, const Eigen::MatrixXd& analytic,
                                 double scale) {
  return sweep(f, x, analytic, scale, Part::whole);
}

DerivativeError compare_gradient(const std::function<double(const Eigen::VectorXd&)>& f,
                                 const Eigen::VectorXd& x, const Eigen::VectorXd& analytic, double scale) {
  const auto vector_valued = [&f](const Eigen::VectorXd& at) { return Eigen::VectorXd::Constant(1, f(at)); };
  return sweep(vector_valued, x, analytic.transpose(), scale, Part::whole);
}

DerivativeError compare_symmetric_part(const Function& gradient, const Eigen::VectorXd& x,
                                       const Eigen::MatrixXd& hessian, double scale) {
  return sweep(gradient, x, hessian, scale, Part::symmetric);
}

}  // namespace snare::test
