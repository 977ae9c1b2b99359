#include "identification/published/fit_ranges.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

/// Height over the chord to which a point of an inextensible wire can be pushed [m]: an ellipse about the
/// mounts.
double taut_height(const coupling::PushProblem& test) {
  const double a = 0.5 * test.wire.length, c = 0.5 * test.mount.span, x = test.contact_position - c;
  return std::sqrt(std::max(0.0, (a * a - c * c) * (1.0 - x * x / (a * a))));
}

bool is_taut(const FitRange& range) {
  return range.kind == FitRange::Kind::taut_from_touch || range.kind == FitRange::Kind::taut_from_chord;
}

}  // namespace

std::string to_string(FitRange::Kind kind) {
  switch (kind) {
    case FitRange::Kind::common:
      return "common";
    case FitRange::Kind::own:
      return "own";
    case FitRange::Kind::own_even:
      return "own_even";
    case FitRange::Kind::taut_from_touch:
      return "taut_from_touch";
    case FitRange::Kind::taut_from_chord:
      return "taut_from_chord";
  }
  return "";
}

FitCell fit_cell(const QuadraticLaw& law, double to, int readings) {
  FitCell cell;
  Eigen::MatrixXd powers(readings, 3);
  Eigen::VectorXd parabola(readings);
  for (int i = 0; i < readings; ++i) {
    const double d = to * i / (readings - 1);
    cell.travel.push_back(d);
    powers.row(i) << d * d, d, 1.0;
    parabola[i] = law.force(d);
  }
  cell.basis = quadratic_basis(cell.travel);
  cell.log_scale = std::log(std::abs((cell.basis * powers).determinant()));
  const double about_mean = (parabola.array() - parabola.mean()).square().sum();
  cell.numbers = published_numbers(cell.basis * parabola, about_mean, law.r_squared, law.r_squared_digits);
  cell.log_scatter = 0.5 * std::log(about_mean * (1.0 - law.r_squared) / law.r_squared / readings);
  return cell;
}

FitRanges::FitRanges(const std::vector<Series>& series, const std::vector<double>& touch,
                     const Options& options)
    : options_(options) {
  for (const Series& s : series) laws_.push_back(*s.law);
  const auto edge = [&](int i) {
    return options.least * std::pow(options.most / options.least, i / static_cast<double>(options.bins));
  };
  for (int i = 0; i < options.bins; ++i)
    ranges_.push_back({FitRange::Kind::common, std::vector<double>(laws_.size(), edge(i + 1)), edge(i)});
  if (laws_.size() > 1)
    for (const FitRange::Kind kind : {FitRange::Kind::own, FitRange::Kind::own_even})
      ranges_.push_back({kind, std::vector<double>(laws_.size(), options.most), options.least});
  FitRange from_touch{FitRange::Kind::taut_from_touch, {}}, from_chord{FitRange::Kind::taut_from_chord, {}};
  for (std::size_t k = 0; k < laws_.size(); ++k) {
    const double height = taut_height(series[k].test);
    from_chord.to.push_back(height);
    from_touch.to.push_back(height - touch[k]);
  }
  for (const FitRange& range : {from_touch, from_chord})
    if (std::ranges::all_of(range.to, [](double to) { return to > 1e-4; })) ranges_.push_back(range);
  fill();
}

FitCells FitRanges::at(const std::vector<double>& to) const {
  FitCells result{to, {}};
  for (std::size_t n = 0; n < options_.readings.size(); ++n)
    for (FitCell& cell : at(to, n).cells) result.cells.push_back(std::move(cell));
  return result;
}

FitCells FitRanges::at(const std::vector<double>& to, std::size_t readings) const {
  FitCells result{to, {}};
  for (std::size_t k = 0; k < laws_.size(); ++k)
    result.cells.push_back(fit_cell(laws_[k], to[k], options_.readings[readings]));
  return result;
}

void FitRanges::fill() {
  edges_.clear();
  taut_.clear();
  single_.clear();
  edges_.push_back(at(std::vector<double>(laws_.size(), ranges_.front().from)));
  for (std::size_t r = 0; r < bins(); ++r) edges_.push_back(at(ranges_[r].to));
  for (const FitRange& range : ranges_)
    if (is_taut(range)) taut_.push_back(at(range.to));
  if (laws_.size() == 1) return;
  for (const QuadraticLaw& law : laws_) {
    FitRanges& one = single_.emplace_back(FitRanges(options_));
    one.laws_ = {law};
    for (std::size_t r = 0; r < bins(); ++r)
      one.ranges_.push_back({FitRange::Kind::common, {ranges_[r].to[0]}, ranges_[r].from});
    one.fill();
  }
}

FitRanges FitRanges::of(const std::vector<QuadraticLaw>& laws) const {
  FitRanges result = *this;
  result.laws_ = laws;
  result.fill();
  return result;
}

double FitRanges::longest() const {
  double most = 0.0;
  for (const FitRange& range : ranges_) most = std::max(most, std::ranges::max(range.to));
  return most;
}

double FitRanges::mass(std::size_t range, bool uniform) const {
  const FitRange& r = ranges_[range];
  const double taut = taut_.empty() ? 0.0 : 0.5, own = single_.empty() ? 0.0 : 0.5 * (1.0 - taut);
  const double one = 1.0 / static_cast<double>(options_.readings.size());
  if (is_taut(r)) return taut / static_cast<double>(taut_.size()) * one;
  if (r.kind != FitRange::Kind::common)
    return (r.kind == FitRange::Kind::own_even) == uniform ? own * one : 0.0;
  const double share =
      uniform ? (r.to[0] - r.from) / (options_.most - options_.least) : 1.0 / static_cast<double>(bins());
  return (1.0 - taut - own) * share * one;
}

}  // namespace snare::identification
