#include "wire/motion/rod_slots.hpp"

#include <algorithm>
#include <cstdlib>

namespace snare::wire {

namespace {

/// Whether two unknowns of the band are in one cell: x_{i-1}, x_i, x_{i+1} and the angles of the edges
/// between.
bool share_a_cell(int i, int j) {
  const int between = j / RodModel::block - i / RodModel::block;
  const bool angle_i = RodModel::is_angle(i), angle_j = RodModel::is_angle(j);
  if (angle_i && angle_j) return std::abs(between) <= 1;
  if (angle_j) return between >= -2 && between <= 1;  // edge e is in the cells of the vertices e and e + 1
  if (angle_i) return between >= -1 && between <= 2;
  return std::abs(between) <= 2;
}

}  // namespace

void append_sparsity(const RodModel& model, std::vector<std::pair<int, int>>& entries) {
  constexpr int reach = SpatialRod::half_bandwidth;
  const int bands = model.bands();
  const bool damped = model.bends_with_loss() || model.damping().axial_time > 0.0;
  // Strands: z by z, z by places and rates of its cell, the cell's balances by z.
  for (int i = 0; model.strands().act() && i < model.vertices(); ++i) {
    const int first = CellRows::first_band(i);
    for (int z = model.strand_of(i); z < model.strand_of(i) + 2; ++z) {
      entries.emplace_back(z, model.strand_of(i));
      entries.emplace_back(z, model.strand_of(i) + 1);
      for (int j = std::max(0, first); j < std::min(bands, first + CellRows::count); ++j) {
        entries.emplace_back(z, model.unknown_of(j));
        if (!RodModel::is_angle(j)) entries.emplace_back(z, model.rate_of(j));
        entries.emplace_back(model.balance_of(j), z);
      }
    }
  }
  // Of higher order: k by itself, by its neighbours and by its cell, the cell's balances by k.
  for (int i = 0; model.is_curved() && i < model.vertices(); ++i) {
    const int first = CellRows::first_band(i);
    const bool bends = BendingCell::exists(model, i);
    for (int k = model.curvature_of(i); k < model.curvature_of(i) + 2; ++k) {
      for (int other = model.curvature_of(i); other < model.curvature_of(i) + 2; ++other) {
        entries.emplace_back(k, other);
        if (bends && i > 0) entries.emplace_back(k, other - 2);
        if (bends && i < model.edges()) entries.emplace_back(k, other + 2);
      }
      for (int j = std::max(0, first); j < std::min(bands - 1, first + CellRows::count); ++j) {
        if (bends) entries.emplace_back(k, model.unknown_of(j));
        if (!model.is_held(j)) entries.emplace_back(model.balance_of(j), k);
      }
    }
  }
  for (int i = 0; i < bands; ++i) {
    const int at = model.unknown_of(i);
    entries.emplace_back(at, at);
    if (!RodModel::is_angle(i)) {
      if (!model.is_held(i)) entries.emplace_back(at, model.rate_of(i));
      entries.emplace_back(model.rate_of(i), model.rate_of(i));
    }
    if (model.is_held(i)) continue;
    for (int j = std::max(0, i - reach); j <= std::min(bands - 1, i + reach); ++j) {
      if (!share_a_cell(i, j)) continue;
      entries.emplace_back(model.balance_of(i), model.unknown_of(j));
      if (damped && !RodModel::is_angle(j)) entries.emplace_back(model.balance_of(i), model.rate_of(j));
    }
  }
}

void RodSlots::attach(const RodModel& model, const numerics::SparseMatrix& pattern) {
  pattern_ = &pattern;
  bands_ = model.bands();
  place_.assign(base::at(bands_ * width), -1);
  rate_.assign(base::at(bands_ * width), -1);
  diagonal_.assign(base::at(bands_), {});
  for (int i = 0; i < bands_; ++i) {
    const int at = model.unknown_of(i);
    Diagonal& d = diagonal_[base::at(i)];
    d.place = pattern.slot(at, at);
    const int balance = model.balance_of(i);
    if (!RodModel::is_angle(i)) {
      d.place_by_velocity = pattern.slot(at, balance);
      d.velocity = pattern.slot(balance, balance);
    }
    if (model.is_held(i)) continue;
    for (int j = std::max(0, i - reach); j <= std::min(bands_ - 1, i + reach); ++j) {
      place_[slot_of(i, j)] = pattern.slot(balance, model.unknown_of(j));
      if (!RodModel::is_angle(j)) rate_[slot_of(i, j)] = pattern.slot(balance, model.rate_of(j));
    }
  }
  cells_.resize(base::at(model.vertices()));
  for (int i = 0; i < model.vertices(); ++i) {
    CellSlots& cell = cells_[base::at(i)];
    cell.place.fill(-1);
    cell.rate.fill(-1);
    const int first = CellRows::first_band(i);
    const int begin = std::max(0, -first), end = std::min(CellRows::count, bands_ - 1 - first);
    for (int b = begin; b < end; ++b) {
      for (int a = begin; a < end; ++a) {
        cell.place[base::at(CellRows::count * b + a)] = place_[slot_of(first + a, first + b)];
        cell.rate[base::at(CellRows::count * b + a)] = rate_[slot_of(first + a, first + b)];
      }
    }
  }
}

namespace {

using CellColumn = std::array<double, CellRows::count>;

/// What a cell does to its balances by one of its unknowns: an angle's rate is c times the angle, a place's
/// an unknown of its own.
template <class Slots>
void add_column(const Slots& slots, std::size_t column, const CellColumn& by_place, const CellColumn& by_rate,
                double c, std::vector<double>& values) {
  const int* place = slots.place.data() + by_place.size() * column;
  const int* rate = slots.rate.data() + by_rate.size() * column;
  const bool angle = column == CellRows::angle_before || column == CellRows::angle_after;
  for (std::size_t a = 0; a < by_place.size(); ++a) {
    RodSlots::add_to(values, place[a], angle ? by_place[a] + c * by_rate[a] : by_place[a]);
    if (!angle) RodSlots::add_to(values, rate[a], by_rate[a]);
  }
}

}  // namespace

void RodSlots::add_cell(int i, const CellMatrix& by_place, const CellMatrix& by_rate, double c,
                        std::vector<double>& values) const {
  for (std::size_t b = 0; b < CellRows::count; ++b) {
    CellColumn place, rate;
    for (std::size_t a = 0; a < CellRows::count; ++a) {
      place[a] = by_place(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      rate[a] = by_rate(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
    }
    add_column(cells_[base::at(i)], b, place, rate, c, values);
  }
}

void RodSlots::add_cell(int i, const CellProducts& products, double c, std::vector<double>& values) const {
  const auto& [force, place, rate, m] = products;
  for (std::size_t b = 0; b < CellRows::count; ++b) {
    const auto column = static_cast<Eigen::Index>(b);
    CellColumn by_place, by_rate;
    for (std::size_t a = 0; a < CellRows::count; ++a) {
      const auto row = static_cast<Eigen::Index>(a);
      by_place[a] = force[0][row] * place[0][column] + force[1][row] * place[1][column] + m(row, column);
      by_rate[a] = force[0][row] * rate[0][column] + force[1][row] * rate[1][column];
    }
    add_column(cells_[base::at(i)], b, by_place, by_rate, c, values);
  }
}

}  // namespace snare::wire
