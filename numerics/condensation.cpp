#include "numerics/condensation.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <cassert>

namespace snare::numerics {

using base::at;

Condensation::Condensation(const SparseMatrix& pattern, const std::vector<std::pair<int, int>>& pairs) {
  const int n = pattern.order;
  std::vector<int> entries(at(n), 0);  // of every row
  for (const int i : pattern.row) ++entries[at(i)];
  pair_of_.assign(at(n), -1);
  std::vector<int> place_of(at(n), -1);  // of every p: its pair
  for (const auto& [p, v] : pairs) {
    const int own = pattern.slot(p, p), rate = pattern.slot(p, v);
    if (entries[at(p)] != 2 || own < 0 || rate < 0 || pair_of_[at(v)] >= 0) continue;
    place_of[at(p)] = pair_of_[at(v)] = static_cast<int>(pairs_.size());
    pairs_.emplace_back(p, v);
    own_slot_.push_back(own);
    rate_slot_.push_back(rate);
  }
  ratio_.assign(pairs_.size(), 0.0);
  pivot_.assign(pairs_.size(), -1.0);
  given_.assign(pairs_.size(), 0.0);
  std::vector<int> row_index(at(n), -1), column_index(at(n), -1);
  for (int u = 0; u < n; ++u) {
    if (pair_of_[at(u)] >= 0) continue;
    const int diagonal = pattern.slot(u, u),
              in_column = pattern.column_start[at(u) + 1] - pattern.column_start[at(u)];
    if (!pairs_.empty() && diagonal >= 0 && entries[at(u)] == 1 && in_column == 1) {
      alone_.push_back(u);
      alone_slot_.push_back(diagonal);
      continue;
    }
    const int place = place_of[at(u)];
    const int row = place >= 0 ? pairs_[at(place)].second : u;
    row_index[at(row)] = column_index[at(u)] = static_cast<int>(column_.size());
    row_.push_back(row);
    column_.push_back(u);
  }
  for (const auto& [p, v] : pairs_) column_index[at(v)] = column_index[at(p)];
  of_alone_.assign(alone_.size(), 0.0);
  std::vector<std::pair<int, int>> left;
  left.reserve(pattern.row.size());
  const auto visit = [&](const auto& use) {
    for (int j = 0; j < n; ++j) {
      for (int s = pattern.column_start[at(j)]; s < pattern.column_start[at(j) + 1]; ++s)
        use(s, row_index[at(pattern.row[at(s)])], column_index[at(j)]);
    }
  };
  visit([&](int, int i, int j) {
    if (i >= 0 && j >= 0) left.emplace_back(i, j);
  });
  matrix_ = make_pattern(static_cast<int>(column_.size()), left);
  target_.assign(pattern.row.size(), -1);
  visit([&](int s, int i, int j) {
    if (i >= 0 && j >= 0) target_[at(s)] = matrix_.slot(i, j);
  });
  for (const auto& [p, v] : pairs_) {
    first_rate_.push_back(rates_.size());
    for (int s = pattern.column_start[at(v)]; s < pattern.column_start[at(v) + 1]; ++s) {
      const int row = row_index[at(pattern.row[at(s)])];
      if (row < 0) continue;
      const bool goes_on = rates_.size() > first_rate_.back() &&
                           rates_.back().slot + rates_.back().length == s &&
                           rates_.back().row + rates_.back().length == row;
      if (goes_on)
        ++rates_.back().length;
      else
        rates_.push_back({s, row, 1});
    }
  }
  first_rate_.push_back(rates_.size());
}

bool Condensation::update(const SparseMatrix& full) {
  assert(full.row.size() == target_.size());
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    pivot_[k] = full.value[at(rate_slot_[k])];
    if (pivot_[k] == 0.0) return false;
    ratio_[k] = -full.value[at(own_slot_[k])] / pivot_[k];
  }
  for (const int slot : alone_slot_) {
    if (full.value[at(slot)] == 0.0) return false;
  }
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
  for (int j = 0; j < full.order; ++j) {
    const int pair = pair_of_[at(j)];
    const double factor = pair >= 0 ? ratio_[at(pair)] : 1.0;
    for (int s = full.column_start[at(j)]; s < full.column_start[at(j) + 1]; ++s) {
      if (target_[at(s)] >= 0) matrix_.value[at(target_[at(s)])] += factor * full.value[at(s)];
    }
  }
  return true;
}

// A_iv v = A_iv r/b + A_iv (-a/b) x: the first goes to the right.
void Condensation::reduce(const SparseMatrix& full, Eigen::Ref<const Eigen::VectorXd> b,
                          Eigen::VectorXd& reduced) {
  const auto left = static_cast<Eigen::Index>(row_.size());
  reduced.resize(left);
  for (Eigen::Index k = 0; k < left; ++k) reduced[k] = b[row_[static_cast<std::size_t>(k)]];
  for (std::size_t k = 0; k < alone_.size(); ++k)
    of_alone_[k] = b[alone_[k]] / full.value[at(alone_slot_[k])];
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    given_[k] = b[pairs_[k].first] / pivot_[k];
    if (given_[k] == 0.0) continue;
    for (std::size_t e = first_rate_[k]; e < first_rate_[k + 1]; ++e) {
      const Run& run = rates_[e];
      const Eigen::Map<const Eigen::VectorXd> entries(full.value.data() + run.slot, run.length);
      reduced.segment(run.row, run.length) -= given_[k] * entries;
    }
  }
}

void Condensation::expand(const Eigen::VectorXd& reduced, Eigen::Ref<Eigen::VectorXd> x) const {
  for (Eigen::Index k = 0; k < reduced.size(); ++k) x[column_[static_cast<std::size_t>(k)]] = reduced[k];
  for (std::size_t k = 0; k < alone_.size(); ++k) x[alone_[k]] = of_alone_[k];
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    x[pairs_[k].second] = given_[k] + ratio_[k] * x[pairs_[k].first];
}

}  // namespace snare::numerics
