#include "wire/rod_slots.hpp"

#include <algorithm>

namespace snare::wire {

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
      entries.emplace_back(at, model.rate_of(i));
      entries.emplace_back(model.rate_of(i), model.rate_of(i));
    }
    if (model.is_held(i)) continue;
    for (int j = std::max(0, i - reach); j <= std::min(bands - 1, i + reach); ++j) {
      // A round rod's twist acts through the edges' vectors of both sides: within the band everything may be
      // filled.
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
  curvature_.assign(model.is_curved() ? base::at(model.vertices()) : 0, {});
  for (int i = 0; model.is_curved() && i < model.vertices(); ++i) {
    CurvatureSlots& slots = curvature_[base::at(i)];
    const int first = CellRows::first_band(i);
    const int k = model.curvature_of(i);
    for (int j = 0; j < 2; ++j) {
      for (int a = 0; a < CellRows::count; ++a) {
        const bool there = first + a >= 0 && first + a < bands_ - 1;
        slots.column[base::at(a)][base::at(j)] = there ? pattern.slot(model.balance_of(first + a), k + j) : -1;
        slots.row[base::at(a)][base::at(j)] = there ? pattern.slot(k + j, model.unknown_of(first + a)) : -1;
      }
      for (int m = 0; m < 2; ++m) {
        const bool last = i == model.edges();
        slots.own[base::at(j)][base::at(m)] = pattern.slot(k + j, k + m);
        slots.next[base::at(j)][base::at(m)] = last ? -1 : pattern.slot(k + j, k + 2 + m);
        slots.next_transposed[base::at(j)][base::at(m)] = last ? -1 : pattern.slot(k + 2 + j, k + m);
      }
    }
  }
}

void RodSlots::add_cell(int i, const CellMatrix& by_place, std::vector<double>& values) const {
  const int first = CellRows::first_band(i);
  const int begin = std::max(0, -first);
  const int end = std::min(CellRows::count, bands_ - 1 - first);
  for (int a = begin; a < end; ++a) {
    for (int b = begin; b < end; ++b) add_place(first + a, first + b, by_place(a, b), values);
  }
}

void RodSlots::add_curvature(int i, const CurvatureColumns& by_cell, const Eigen::Matrix2d& own,
                             std::vector<double>& values) const {
  const CurvatureSlots& slots = curvature_[base::at(i)];
  for (std::size_t j = 0; j < 2; ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    for (int a = 0; a < CellRows::count; ++a) {
      add_to(values, slots.column[base::at(a)][j], by_cell(a, column));
      add_to(values, slots.row[base::at(a)][j], by_cell(a, column));
    }
    for (std::size_t m = 0; m < 2; ++m) add_to(values, slots.own[j][m], own(column, static_cast<Eigen::Index>(m)));
  }
}

void RodSlots::add_curvature_pair(int i, const Eigen::Matrix2d& block, std::vector<double>& values) const {
  const CurvatureSlots& slots = curvature_[base::at(i)];
  for (std::size_t j = 0; j < 2; ++j) {
    for (std::size_t m = 0; m < 2; ++m) {
      const double value = block(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(m));
      add_to(values, slots.next[j][m], value);
      add_to(values, slots.next_transposed[m][j], value);
    }
  }
}

void RodSlots::add_cell(int i, const CellMatrix& by_place, const CellMatrix& by_rate, double c, int columns,
                        std::vector<double>& values) const {
  const int first = CellRows::first_band(i);
  for (int a = 0; a < CellRows::count; ++a) {
    const int row = first + a;
    if (row < 0 || row >= bands_) continue;
    for (int b = 0; b < CellRows::count; ++b) {
      const int column = first + b;
      if (column < 0 || column >= columns) continue;
      const bool angle = RodModel::is_angle(column);
      add_place(row, column, by_place(a, b) + (angle ? c * by_rate(a, b) : 0.0), values);
      if (!angle) add_rate(row, column, by_rate(a, b), values);
    }
  }
}

}  // namespace snare::wire
