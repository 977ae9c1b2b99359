#include "reduction/law_simulators.hpp"

#include "reduction/law_export.hpp"

#include <fmt/format.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <vector>

namespace snare::reduction {

namespace {

/// F = k0 d + k1 d^2 + k2 d^3, the form of MuJoCo's joint springs, by least squares over even travels.
struct JointPolynomial {
  Eigen::Vector3d stiffness;   ///< k0, k1, k2 [N/m, N/m^2, N/m^3]
  double largest_error = 0.0;  ///< against the full wire, at four travels for every one of the fit [N]
};

JointPolynomial joint_polynomial(const DistilledPlace& place, double end) {
  constexpr int points = 200;
  Eigen::MatrixX3d powers(points, 3);
  Eigen::VectorXd force(points);
  for (int i = 0; i < points; ++i) {
    const double share = (i + 1.0) / points;
    powers.row(i) << share, share * share, share * share * share;
    force[i] = place.full.value(share * end);
  }
  const Eigen::Vector3d scaled = powers.colPivHouseholderQr().solve(force);
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
  std::string words = title;
  for (std::size_t at = words.find("--"); at != std::string::npos; at = words.find("--")) words.erase(at, 1);
  std::string text = fmt::format(
      "<!-- {}\n     Springs of the snare wire, one slide joint a position, travel from first touch: the force of a "
      "joint is\n"
      "     -q (k0 + k1 q + k2 q^2), stiffness=\"k0 k1 k2\". MuJoCo before its polynomial stiffness takes one number: "
      "the\n"
      "     linear law that is named for each. Friction and strands dissipate at any rate alike, which a joint cannot. "
      "-->\n"
      "<mujoco model=\"snare_wire\">\n  <worldbody>\n",
      words);
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
  }
  return text + "  </worldbody>\n</mujoco>\n";
}

namespace {

/// "a, b, c" in lines that ADAMS takes, each continued by a leading comma.
std::string adams_numbers(const std::string& key, const std::vector<double>& values) {
  std::string text = ", " + key + "=";
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : i % 5 == 0 ? "\n, " : ", ", values[i]);
  return text + "\n";
}

}  // namespace

std::string adams_splines(const DistilledCase& one, const std::string& title) {
  const coupling::ForceTable& table = *one.table.loading;
  std::vector<double> travel = table.axes()[0];
  for (double& d : travel) d *= table.span();
  std::string words = title;
  std::replace(words.begin(), words.end(), '\n', ' ');
  std::string text = "! " + words + "\n! Force of a snare wire [N] over travel from first touch [m], by snare.\n";
  int number = 1;
  for (const DistilledPlace& place : one.places) {
    std::vector<double> force;
    force.reserve(travel.size());
    for (const double d : travel) force.push_back(place.full.value(d));
    text += fmt::format("! s = {:.6g} mm, slack {:.6g} mm\nSPLINE/{}\n", 1e3 * place.position,
                        1e3 * one.wire.nominal_slack(), number++);
    text += adams_numbers("X", travel) + adams_numbers("Y", force);
  }
  text += fmt::format("! travel (X) and position s (Z) at a slack of {:.6g} mm\nSPLINE/{}\n",
                      1e3 * one.wire.nominal_slack(), number);
  text += adams_numbers("X", travel);
  for (const double s : table.axes()[1]) {
    // The first number of a Y list is its Z.
    std::vector<double> row{s * table.span()};
    for (const double d : travel) row.push_back(table.force(d, s * table.span(), one.wire.nominal_slack()));
    text += adams_numbers("Y", row);
  }
  return text;
}

namespace {

/// The knots of an axis with `pieces` even pieces between them.
std::vector<double> refined(const std::vector<double>& knots, int pieces) {
  std::vector<double> more{knots.front()};
  for (std::size_t i = 1; i < knots.size(); ++i) {
    for (int k = 1; k <= pieces; ++k) more.push_back(knots[i - 1] + (knots[i] - knots[i - 1]) * k / pieces);
  }
  return more;
}

/// A grid of travels and positions [m] at one slack.
struct Grid {
  std::vector<double> travel, position;
  Eigen::MatrixXd force;  ///< a row a travel [N]
};

Grid grid_of(const coupling::ForceTable& table, double slack, int pieces) {
  Grid grid;
  for (const double d : refined(table.axes()[0], pieces)) grid.travel.push_back(d * table.span());
  std::vector<double> places = table.axes()[1];
  if (table.mirrored()) {
    for (auto k = static_cast<std::ptrdiff_t>(places.size()) - 1; k >= 0; --k) {
      const double other = 1.0 - places[static_cast<std::size_t>(k)];
      if (other > places.back() * (1.0 + 1e-9)) places.push_back(other);
    }
  }
  for (const double s : refined(places, pieces)) grid.position.push_back(s * table.span());
  grid.force.resize(static_cast<Eigen::Index>(grid.travel.size()), static_cast<Eigen::Index>(grid.position.size()));
  for (Eigen::Index i = 0; i < grid.force.rows(); ++i) {
    for (Eigen::Index k = 0; k < grid.force.cols(); ++k) {
      grid.force(i, k) =
          table.force(grid.travel[static_cast<std::size_t>(i)], grid.position[static_cast<std::size_t>(k)], slack);
    }
  }
  return grid;
}

/// Of bilinear interpolation, at three times three places in every cell [N].
double bilinear_error(const coupling::ForceTable& table, double slack, const Grid& grid) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i + 1 < grid.force.rows(); ++i) {
    for (Eigen::Index k = 0; k < std::max<Eigen::Index>(1, grid.force.cols() - 1); ++k) {
      const Eigen::Index next = std::min(k + 1, grid.force.cols() - 1);
      for (const double u : {0.25, 0.5, 0.75}) {
        for (const double v : {0.25, 0.5, 0.75}) {
          const auto at = [](const std::vector<double>& x, Eigen::Index low, Eigen::Index high, double share) {
            return (1.0 - share) * x[static_cast<std::size_t>(low)] + share * x[static_cast<std::size_t>(high)];
          };
          const double linear = (1.0 - u) * ((1.0 - v) * grid.force(i, k) + v * grid.force(i, next)) +
                                u * ((1.0 - v) * grid.force(i + 1, k) + v * grid.force(i + 1, next));
          const double exact = table.force(at(grid.travel, i, i + 1, u), at(grid.position, k, next, v), slack);
          largest = std::max(largest, std::abs(linear - exact));
        }
      }
    }
  }
  return largest;
}

}  // namespace

LookupTable lookup_table(const DistilledCase& one) {
  constexpr int most_pieces = 16;
  const coupling::ForceTable& table = *one.table.loading;
  const double slack = one.wire.nominal_slack();
  Grid grid;
  double error = 0.0;
  for (int pieces = 1; pieces <= most_pieces; pieces *= 2) {
    grid = grid_of(table, slack, pieces);
    error = bilinear_error(table, slack, grid);
    if (error <= one.table.loading_error.bound) break;
  }
  std::string text;
  for (const double s : grid.position) text += fmt::format(",{}", s);
  text += "\n";
  for (Eigen::Index i = 0; i < grid.force.rows(); ++i) {
    text += fmt::format("{}", grid.travel[static_cast<std::size_t>(i)]);
    for (Eigen::Index k = 0; k < grid.force.cols(); ++k) text += fmt::format(",{}", grid.force(i, k));
    text += "\n";
  }
  return {text, error};
}

std::vector<double> joint_errors(const DistilledCase& one) {
  std::vector<double> errors;
  for (const DistilledPlace& place : one.places)
    errors.push_back(joint_polynomial(place, linear_law(place).range.high).largest_error);
  return errors;
}

}  // namespace snare::reduction
