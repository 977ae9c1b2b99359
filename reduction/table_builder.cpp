#include "reduction/table_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace snare::reduction {

namespace {

constexpr int travel_steps = 120;    // intervals of the sampling
constexpr int pilot_intervals = 24;  // along position and slack
constexpr int most_rounds = 8;

std::vector<double> spread(const Interval& range, int intervals) {
  if (range.fixed()) return {range.low};
  std::vector<double> x;
  x.reserve(static_cast<std::size_t>(intervals) + 1);
  for (int i = 0; i < intervals; ++i) x.push_back(range.low + (range.high - range.low) * i / intervals);
  x.push_back(range.high);
  return x;
}

std::vector<double> pick(const std::vector<double>& from, const std::vector<std::size_t>& indices) {
  std::vector<double> result;
  result.reserve(indices.size());
  for (const std::size_t i : indices) result.push_back(from[i]);
  return result;
}

/// Knots with the middles of their intervals between them.
std::vector<double> with_middles(const std::vector<double>& knots) {
  std::vector<double> result{knots.front()};
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    result.push_back(0.5 * (knots[i] + knots[i + 1]));
    result.push_back(knots[i + 1]);
  }
  return result;
}

/// Every position with every slack.
std::vector<CurvePlace> grid(const std::vector<double>& positions, const std::vector<double>& slacks) {
  std::vector<CurvePlace> places;
  for (const double s : positions) {
    for (const double e : slacks) places.push_back({s, e});
  }
  return places;
}

using Branch = std::vector<double> PushedCurve::*;

class TableBuilder {
 public:
  TableBuilder(CurveStore& store, const DistilSettings& settings, const SamplingObserver& observer)
      : store_(store), settings_(settings), observer_(observer) {}

  BuiltTable run();

 private:
  [[nodiscard]] bool place();
  [[nodiscard]] std::unique_ptr<coupling::ForceTable> tabulate(Branch branch) const;
  [[nodiscard]] TableError check(const coupling::ForceTable& table, Branch branch);
  [[nodiscard]] bool refine();
  [[nodiscard]] bool sample(const std::vector<CurvePlace>& places);

  CurveStore& store_;
  const DistilSettings& settings_;
  const SamplingObserver& observer_;
  BuiltTable built_;
  std::vector<std::size_t> travel_;       // indices of the knots in the sampling's travels
  std::vector<double> position_, slack_;  // knots
  // Largest error of the check a cell of each axis, from points off the knots in that axis alone.
  std::array<std::vector<double>, 3> cell_error_;
};

bool TableBuilder::sample(const std::vector<CurvePlace>& places) {
  built_.report = store_.sample(places, observer_);
  return built_.report.usable();
}

// Pilot lines: the position at the least, middle and largest slack; the slack at three positions.
bool TableBuilder::place() {
  const WireCase& wire = store_.wire();
  const std::vector<double> all_s = spread(wire.position, pilot_intervals);
  const std::vector<double> all_e = spread(wire.slack, pilot_intervals);
  const std::vector<double> few_s = spread(wire.position, 2);
  const std::vector<double> few_e = spread(wire.slack, 2);
  std::vector<CurvePlace> pilots = grid(all_s, few_e);
  const std::vector<CurvePlace> others = grid(few_s, all_e);
  pilots.insert(pilots.end(), others.begin(), others.end());
  if (!sample(pilots)) return false;
  const auto wanted = [&](std::size_t axis) { return static_cast<std::size_t>(settings_.points[axis]); };

  std::vector<std::vector<double>> lines;
  for (const auto& [unused, curve] : store_.curves()) {
    lines.push_back(curve.loading);
    if (!curve.unloading.empty()) lines.push_back(curve.unloading);
  }
  travel_ = place_knots(store_.travel(), lines, wanted(0));

  const auto across = [&](const std::vector<double>& along, const auto& place_of) {
    std::vector<std::vector<double>> result;
    for (std::size_t k = 0; k < store_.travel().size(); k += 8) {
      std::vector<double> line;
      line.reserve(along.size());
      for (const double x : along) line.push_back(store_.at(place_of(x)).loading[k]);
      result.push_back(std::move(line));
    }
    return result;
  };
  lines.clear();
  for (const double e : few_e) {
    for (auto& line : across(all_s, [&](double s) { return CurvePlace{store_.folded(s), e}; }))
      lines.push_back(std::move(line));
  }
  position_ = pick(all_s, place_knots(all_s, lines, wanted(1)));
  lines.clear();
  for (const double s : few_s) {
    for (auto& line : across(all_e, [&](double e) { return CurvePlace{store_.folded(s), e}; }))
      lines.push_back(std::move(line));
  }
  slack_ = pick(all_e, place_knots(all_e, lines, wanted(2)));
  return true;
}

std::unique_ptr<coupling::ForceTable> TableBuilder::tabulate(Branch branch) const {
  const WireCase& wire = store_.wire();
  const double span = wire.test.mount.span;
  std::vector<double> values, slopes;
  const std::vector<double> knots = pick(store_.travel(), travel_);
  for (const double e : slack_) {
    for (const double s : position_) {
      const std::vector<double>& force = store_.at({store_.folded(s), e}).*branch;
      const numerics::HermiteCurve dense(store_.travel(), force);  // through all travels: slopes nearly exact
      const std::vector<double> at_knots = pick(force, travel_);
      const std::vector<double> m = numerics::monotone_slopes(knots, at_knots, pick(dense.slopes(), travel_));
      values.insert(values.end(), at_knots.begin(), at_knots.end());
      slopes.insert(slopes.end(), m.begin(), m.end());
    }
  }
  coupling::ForceTable::Axes axes{knots, position_, slack_};
  for (std::vector<double>& axis : axes) {
    for (double& x : axis) x /= span;
  }
  return std::make_unique<coupling::ForceTable>(std::move(axes), values, slopes, span,
                                                wire.test.wire.bending_stiffness(), wire.symmetric());
}

TableError TableBuilder::check(const coupling::ForceTable& table, Branch branch) {
  TableError error;
  const std::vector<double> positions = with_middles(position_);
  const std::vector<double> slacks = with_middles(slack_);
  const std::vector<double>& travel = store_.travel();
  double least = 0.0;
  double most = 0.0;
  double sum = 0.0;
  double stiffness_sum = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t j = 0; j < slacks.size(); ++j) {
      const PushedCurve& curve = store_.at({store_.folded(positions[i]), slacks[j]});
      const std::vector<double>& force = curve.*branch;
      const numerics::HermiteCurve dense(travel, force);
      const numerics::HermiteCurve tabled = table.curve(positions[i], slacks[j]);
      error.discretisation = std::max(error.discretisation, curve.discretisation_error);
      for (std::size_t k = 0; k < travel.size(); ++k) {
        least = std::min(least, force[k]);
        most = std::max(most, force[k]);
        const double miss = std::abs(tabled.value(travel[k]) - force[k]);
        const double off = std::abs(tabled.slope(travel[k]) - dense.slope(travel[k]));
        sum += miss * miss;
        stiffness_sum += off * off;
        ++error.points;
        error.largest_stiffness = std::max(error.largest_stiffness, off);
        error.largest_energy =
            std::max(error.largest_energy, std::abs(tabled.integral(travel[k]) - dense.integral(travel[k])));
        if (miss > error.largest) {
          error.largest = miss;
          error.worst = {positions[i], slacks[j]};
          error.worst_travel = travel[k];
        }
        const auto note = [&](std::size_t axis, std::size_t cell) {
          double& worst = cell_error_[axis][std::min(cell, cell_error_[axis].size() - 1)];
          worst = std::max(worst, miss);
        };
        const bool knot = std::binary_search(travel_.begin(), travel_.end(), k);
        if (i % 2 == 0 && j % 2 == 0 && !knot) {
          note(0, static_cast<std::size_t>(std::upper_bound(travel_.begin(), travel_.end(), k) -
                                           travel_.begin() - 1));
        } else if (i % 2 == 1 && j % 2 == 0 && knot) {
          note(1, i / 2);
        } else if (i % 2 == 0 && j % 2 == 1 && knot) {
          note(2, j / 2);
        }
      }
    }
  }
  error.force_range = most - least;
  error.rms = std::sqrt(sum / static_cast<double>(error.points));
  error.rms_stiffness = std::sqrt(stiffness_sum / static_cast<double>(error.points));
  error.bound = bound_factor * error.largest + error.discretisation;
  return error;
}

// Halves every cell whose share of the error is more than a quarter of what is allowed, worst axis first.
bool TableBuilder::refine() {
  const double allowed = 0.25 * settings_.tolerance / bound_factor *
                         std::max(built_.loading_error.force_range, built_.unloading_error.force_range);
  bool added = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<std::size_t> cells(cell_error_[axis].size());
    std::iota(cells.begin(), cells.end(), 0);
    std::stable_sort(cells.begin(), cells.end(), [&](std::size_t a, std::size_t b) {
      return cell_error_[axis][a] > cell_error_[axis][b];
    });
    std::size_t room = static_cast<std::size_t>(settings_.most_points[axis]);
    const std::size_t present = axis == 0 ? travel_.size() : (axis == 1 ? position_ : slack_).size();
    room = room > present ? room - present : 0;
    std::vector<std::size_t> travel = travel_;
    std::vector<double> knots = axis == 1 ? position_ : slack_;
    for (const std::size_t c : cells) {
      if (room == 0 || cell_error_[axis][c] <= allowed) break;
      if (axis == 0) {
        const std::size_t middle = (travel_[c] + travel_[c + 1]) / 2;
        if (middle == travel_[c]) continue;  // neighbours already
        travel.push_back(middle);
      } else {
        const std::vector<double>& now = axis == 1 ? position_ : slack_;
        if (now.size() < 2) break;
        knots.push_back(0.5 * (now[c] + now[c + 1]));
      }
      --room;
      added = true;
    }
    if (axis == 0) {
      std::sort(travel.begin(), travel.end());
      travel_ = std::move(travel);
    } else {
      std::sort(knots.begin(), knots.end());
      (axis == 1 ? position_ : slack_) = std::move(knots);
    }
  }
  return added;
}

BuiltTable TableBuilder::run() {
  if (!place()) return std::move(built_);
  for (built_.rounds = 0;; ++built_.rounds) {
    if (!sample(grid(with_middles(position_), with_middles(slack_)))) return std::move(built_);
    cell_error_[0].assign(std::max<std::size_t>(1, travel_.size() - 1), 0.0);
    cell_error_[1].assign(std::max<std::size_t>(1, position_.size() - 1), 0.0);
    cell_error_[2].assign(std::max<std::size_t>(1, slack_.size() - 1), 0.0);
    built_.loading = tabulate(&PushedCurve::loading);
    built_.loading_error = check(*built_.loading, &PushedCurve::loading);
    if (store_.wire().dissipates()) {
      built_.unloading = tabulate(&PushedCurve::unloading);
      built_.unloading_error = check(*built_.unloading, &PushedCurve::unloading);
    }
    const double bound = std::max(built_.loading_error.bound, built_.unloading_error.bound);
    const double allowed = settings_.tolerance * built_.loading_error.force_range;
    if (bound <= allowed || built_.rounds == most_rounds || !refine()) break;
  }
  built_.curves = store_.curves().size();
  return std::move(built_);
}

}  // namespace

std::vector<double> sampling_travel(const WireCase& wire, const DistilSettings& settings) {
  return spread(wire.travel, std::max(travel_steps, 4 * settings.points[0]));
}

BuiltTable build_table(CurveStore& store, const DistilSettings& settings, const SamplingObserver& observer) {
  return TableBuilder(store, settings, observer).run();
}

std::vector<std::size_t> place_knots(const std::vector<double>& candidates,
                                     const std::vector<std::vector<double>>& lines, std::size_t count) {
  const std::size_t n = candidates.size();
  std::vector<std::size_t> chosen{0};
  if (n > 1) chosen.push_back(n - 1);
  if (n > 2) chosen.insert(chosen.begin() + 1, n / 2);
  while (chosen.size() < std::min(count, n)) {
    const std::vector<double> knots = pick(candidates, chosen);
    const Eigen::MatrixXd by = numerics::spline_slopes(knots);
    std::vector<double> worst(chosen.size() - 1, 0.0);
    std::vector<std::size_t> where(chosen.size() - 1, 0);
    for (const std::vector<double>& line : lines) {
      const std::vector<double> values = pick(line, chosen);
      const Eigen::VectorXd m =
          by * Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
      const numerics::HermiteCurve spline(knots, values, std::vector<double>(m.begin(), m.end()));
      for (std::size_t c = 0; c + 1 < chosen.size(); ++c) {
        for (std::size_t i = chosen[c] + 1; i < chosen[c + 1]; ++i)
          worst[c] = std::max(worst[c], std::abs(spline.value(candidates[i]) - line[i]));
      }
    }
    // The middle of the worst cell: the error of a spline is largest there, and cells stay alike.
    std::size_t cell = chosen.size();
    for (std::size_t c = 0; c + 1 < chosen.size(); ++c) {
      where[c] = (chosen[c] + chosen[c + 1]) / 2;
      if (where[c] == chosen[c]) continue;
      if (cell == chosen.size() || worst[c] > worst[cell]) cell = c;
    }
    if (cell == chosen.size()) break;
    chosen.insert(chosen.begin() + static_cast<std::ptrdiff_t>(cell) + 1, where[cell]);
  }
  return chosen;
}

}  // namespace snare::reduction
