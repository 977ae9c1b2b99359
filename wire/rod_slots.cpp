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
