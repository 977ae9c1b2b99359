#include "coupling/contact/push_energy.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace snare::coupling {

namespace {

/// Weights of value and slope at the lower knot, then at the upper one, of a cubic over h at t in [0, 1]; and
/// their derivatives.
struct Cubic {
  std::array<double, 4> weight, by, by_twice;

  Cubic(double t, double h)
      : weight{(1 + 2 * t) * (1 - t) * (1 - t), h * t * (1 - t) * (1 - t), t * t * (3 - 2 * t),
               h * t * t * (t - 1)},
        by{6 * t * (t - 1) / h, (1 - t) * (1 - 3 * t), 6 * t * (1 - t) / h, t * (3 * t - 2)},
        by_twice{(12 * t - 6) / (h * h), (6 * t - 4) / h, (6 - 12 * t) / (h * h), (6 * t - 2) / h} {}
};

/// Integral, value and slope of a curve at x >= 0, which continues along a straight line beyond its last
/// knot.
std::array<double, 3> along(const numerics::HermiteCurve& curve, double x) {
  const double end = curve.knots().back();
  const double inside = std::min(x, end), beyond = x - inside;
  const double value = curve.value(inside), slope = curve.slope(inside);
  return {curve.integral(inside) + beyond * (value + 0.5 * beyond * slope), value + beyond * slope, slope};
}

}  // namespace

PushEnergy::PushEnergy(const ForceTable& table, double slack) {
  const auto& [travels, positions, slacks] = table.axes();
  const double span = table.span(), scale = table.force_scale();
  // What the slack leaves of a node: the value and its derivatives d, s, ds.
  std::size_t below = 0;
  std::array<double, 4> share{1.0, 0.0, 0.0, 0.0};
  if (slacks.size() > 1) {
    const double e = std::clamp(slack / span, slacks.front(), slacks.back());
    below = numerics::find_cell(slacks.data(), slacks.size(), e);
    const double h = slacks[below + 1] - slacks[below];
    share = Cubic((e - slacks[below]) / h, h).weight;
  }
  const std::size_t above = std::min(below + 1, slacks.size() - 1);
  const auto node = [&, &travels = travels, &positions = positions](std::size_t k, std::size_t i,
                                                                    std::size_t slot) {
    const auto number = [&](std::size_t j, std::size_t of) {
      return table
          .nodes()[ForceTable::numbers_a_node * (k + travels.size() * (i + positions.size() * j)) + of];
    };
    constexpr std::size_t by_slack = 4;
    return share[0] * number(below, slot) + share[1] * number(below, slot + by_slack) +
           share[2] * number(above, slot) + share[3] * number(above, slot + by_slack);
  };
  const auto add = [&, &travels = travels](std::size_t i, double position, double sense) {
    std::vector<double> x, force, rise, slope, twist;
    for (std::size_t k = 0; k < travels.size(); ++k) {
      x.push_back(travels[k] * span);
      force.push_back(scale * node(k, i, 0));
      rise.push_back(scale / span * node(k, i, 1));
      slope.push_back(sense * scale / span * node(k, i, 2));
      twist.push_back(sense * scale / (span * span) * node(k, i, 3));
    }
    positions_.push_back(position * span);
    lines_.push_back({{x, force, rise}, {x, slope, twist}});
  };
  for (std::size_t i = 0; i < positions.size(); ++i) add(i, positions[i], 1.0);
  if (!table.mirrored()) return;
  for (std::size_t i = positions.size(); i-- > 0;) {
    constexpr double same = 1e-9;  // a knot at mid-span is its own image
    if (1.0 - positions[i] > positions_.back() / span + same) add(i, 1.0 - positions[i], -1.0);
  }
}

PushEnergy::Value PushEnergy::at(double travel, double position) const {
  Value u;
  if (travel < 0.0) return u;
  if (positions_.size() == 1) {
    const auto [energy, force, rise] = along(lines_.front().force, travel);
    u.energy = energy;
    u.by_travel = force;
    u.by_travels = rise;
    return u;
  }
  const double s = std::clamp(position, positions_.front(), positions_.back());
  const std::size_t i = numerics::find_cell(positions_.data(), positions_.size(), s);
  const double h = positions_[i + 1] - positions_[i];
  const Cubic cubic((s - positions_[i]) / h, h);
  const bool moves = s == position;  // beyond the outermost it does not depend on the position
  for (std::size_t k = 0; k < 4; ++k) {
    const Line& line = lines_[i + k / 2];
    const auto [energy, force, rise] = along(k % 2 == 0 ? line.force : line.slope, travel);
    u.energy += cubic.weight[k] * energy;
    u.by_travel += cubic.weight[k] * force;
    u.by_travels += cubic.weight[k] * rise;
    if (!moves) continue;
    u.by_position += cubic.by[k] * energy;
    u.by_both += cubic.by[k] * force;
    u.by_positions += cubic.by_twice[k] * energy;
  }
  return u;
}

}  // namespace snare::coupling
