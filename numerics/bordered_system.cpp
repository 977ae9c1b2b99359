#include "numerics/bordered_system.hpp"

namespace snare::numerics {

void BorderedSystem::reset(int n, int m) {
  band_residual.setZero(n);
  border_residual.setZero(m);
  corner.setZero(m, m);
  rows.clear();
  anchors.clear();
  columns.clear();
}

SparseMatrix to_sparse(const BorderedSystem& system) {
  const int n = system.matrix.order();
  const auto m = static_cast<int>(system.corner.rows());
  std::vector<Triplet> triplets = triplets_of(system.matrix, Triangle::both);
  for (const BorderedSystem::Anchor& a : system.anchors) triplets.push_back({a.band, n + a.border, -1.0});
  for (const auto& [border, values] : system.columns) {
    for (int i = 0; i < n; ++i) {
      if ((*values)[i] != 0.0) triplets.push_back({i, n + border, (*values)[i]});
    }
  }
  for (const BorderedSystem::Entry& entry : system.rows)
    triplets.push_back({n + entry.row, entry.column, entry.value});
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) {
      if (system.corner(i, j) != 0.0) triplets.push_back({n + i, n + j, system.corner(i, j)});
    }
  }
  return from_triplets(n + m, triplets);
}

}  // namespace snare::numerics
