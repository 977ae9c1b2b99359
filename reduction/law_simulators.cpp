#include "reduction/law_simulators.hpp"

#include "base/one_line.hpp"
#include "reduction/export_text.hpp"

#include <fmt/format.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace snare::reduction {

namespace {

using Eigen::Vector3d;

/// F = k0 d + k1 d^2 + k2 d^3, the form of MuJoCo's joint springs.
struct JointPolynomial {
  Vector3d stiffness;          ///< k0, k1, k2 [N/m, N/m^2, N/m^3]
  double largest_error = 0.0;  ///< against the full wire, at four travels for every one of the fit [N]
};

/// Least squares |A x - f| with x = (a, b, c), the polynomial a x + b x^2 + c x^3 over the travel 0 to 1, under conditions g . x >= 0 that
/// suffice for a force that is never negative and, beyond the travel, never falls.
Vector3d rising_cubic(const Eigen::MatrixX3d& powers, const Eigen::VectorXd& force) {
  // Bernstein coefficients of a + b x + c x^2 on [0, 1], coefficients of the slope a + 2 b x + 3 c x^2 in x - 1.
  Eigen::Matrix<double, 6, 3> conditions;
  conditions << 1, 0, 0, /**/ 1, 0.5, 0, /**/ 1, 1, 1, /**/ 1, 2, 3, /**/ 0, 2, 6, /**/ 0, 0, 1;
  // Three unknowns: the best of all sets of at most two active conditions; three would leave no force.
  Vector3d best = Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  const auto attempt = [&](const std::vector<int>& active) {
    Eigen::MatrixXd free = Eigen::MatrixXd::Identity(3, 3);
    if (!active.empty()) {
      const Eigen::MatrixXd bound = conditions(active, Eigen::all).transpose();
      free = Eigen::MatrixXd(bound.fullPivHouseholderQr().matrixQ())
                 .rightCols(3 - static_cast<Eigen::Index>(active.size()));
    }
    Vector3d x = free * (powers * free).colPivHouseholderQr().solve(force);
    const double size = x.cwiseAbs().maxCoeff();
    const double misfit = (powers * x - force).norm();
    if (!((conditions * x).minCoeff() >= -1e-12 * size) || !(misfit < least)) return;
    least = misfit;
    best = x.unaryExpr([size](double v) { return std::abs(v) <= 1e-12 * size ? 0.0 : v; });
  };
  attempt({});
  for (int i = 0; i < conditions.rows(); ++i) {
    attempt({i});
    for (int k = 0; k < i; ++k) attempt({i, k});
  }
  return best;
}

JointPolynomial joint_polynomial(const DistilledPlace& place, double end) {
  constexpr int points = 200;
  Eigen::MatrixX3d powers(points, 3);
  Eigen::VectorXd force(points);
  for (int i = 0; i < points; ++i) {
    const double share = (i + 1.0) / points;
    powers.row(i) << share, share * share, share * share * share;
    force[i] = place.full.value(share * end);
  }
  const Vector3d scaled = rising_cubic(powers, force);
  JointPolynomial result{{scaled[0] / end, scaled[1] / (end * end), scaled[2] / (end * end * end)}, 0.0};
  for (int i = 0; i <= 4 * points; ++i) {
    const double x = i / (4.0 * points);
    const double off = x * (scaled[0] + x * (scaled[1] + x * scaled[2])) - place.full.value(x * end);
    result.largest_error = std::max(result.largest_error, std::abs(off));
  }
  return result;
}

const FittedLaw& linear_law(const DistilledPlace& place) {
  return *std::ranges::find(place.laws, "linear", [](const FittedLaw& law) { return law.form->name(); });
}

}  // namespace

std::string mujoco_snippet(const DistilledCase& one, const std::string& title) {
  // A double hyphen may not stand in a comment of XML.
  std::string words = base::one_line(title);
  for (std::size_t at = words.find("--"); at != std::string::npos; at = words.find("--", at)) words.insert(at + 1, " ");
  std::string text = fmt::format(
      "<!-- {}\n     Springs of the snare wire, one slide joint a position, travel from first touch: the force of a "
      "joint is\n"
      "     -q (k0 + k1 q + k2 q^2), stiffness=\"k0 k1 k2\". MuJoCo before its polynomial stiffness takes one number: "
      "the\n"
      "     linear law that is named for each. Friction and strands dissipate at any rate alike, which a joint "
      "cannot.\n"
      "     No force is negative at travels from 0 on, nor is the stiffness beyond the range. wire_travel_*_range is "
      "the\n"
      "     range [m]; the sensor wire_travel_*_outside is 0 within it and negative where a joint has left it. -->\n"
      "<mujoco model=\"snare_wire\">\n  <worldbody>\n",
      words);
  std::string ranges, flags;
  for (const DistilledPlace& place : one.places) {
    const FittedLaw& linear = linear_law(place);
    const double end = linear.range.high;
    const JointPolynomial spring = joint_polynomial(place, end);
    const double loss = place.dissipation ? place.dissipation->damping_times_rate : 0.0;
    const bool impact = !place.impacts.empty() && place.impacts.front().damping.has_value();
    const std::string name = position_name(place.position);
    text += fmt::format(
        "    <!-- s = {:.6g} mm, travel 0 to {:.6g} mm: off the full wire by up to {:.3g} N of {:.4g} N; the linear "
        "law,\n"
        "         stiffness=\"{:.6g}\", by up to {:.3g} N. The damping is {}; friction and strands add {:.4g} N/m\n"
        "         over the angular rate. -->\n"
        "    <body name=\"wire_contact_{}\">\n"
        "      <joint name=\"wire_travel_{}\" type=\"slide\" axis=\"0 1 0\" stiffness=\"{} {} {}\" springref=\"0\" "
        "damping=\"{}\"\n"
        "             limited=\"true\" range=\"0 {}\"/>\n"
        "      <geom type=\"sphere\" size=\"0.001\" mass=\"0.001\" contype=\"0\" conaffinity=\"0\"/>\n    </body>\n",
        1e3 * place.position, 1e3 * end, spring.largest_error, linear.error.force_range, linear.values[0],
        linear.error.largest_force,
        impact ? fmt::format("that of an impact at {:.4g} m/s", place.impacts.front().speed)
               : "not known: no impacts were asked",
        loss, name, name, spring.stiffness[0], spring.stiffness[1], spring.stiffness[2],
        impact ? *place.impacts.front().damping : 0.0, end);
    ranges += fmt::format("    <numeric name=\"wire_travel_{}_range\" data=\"0 {}\"/>\n", name, end);
    flags += fmt::format("    <jointlimitpos name=\"wire_travel_{0}_outside\" joint=\"wire_travel_{0}\"/>\n", name);
  }
  return text + fmt::format("  </worldbody>\n  <custom>\n{}  </custom>\n  <sensor>\n{}  </sensor>\n</mujoco>\n", ranges,
                            flags);
}

std::vector<double> joint_errors(const DistilledCase& one) {
  std::vector<double> errors;
  for (const DistilledPlace& place : one.places)
    errors.push_back(joint_polynomial(place, linear_law(place).range.high).largest_error);
  return errors;
}

}  // namespace snare::reduction
