#include "numerics/klu.hpp"

#include "base/errors.hpp"

#include <klu.h>

#include <cassert>
#include <vector>

namespace snare::numerics {

struct Klu::Handles {
  klu_common common{};
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  int order = 0;

  Handles() { klu_defaults(&common); }
  ~Handles() {
    if (numeric != nullptr) klu_free_numeric(&numeric, &common);
    if (symbolic != nullptr) klu_free_symbolic(&symbolic, &common);
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
};

Klu::Klu(const SparseMatrix& pattern) : handles_(new Handles) {
  handles_->order = pattern.order;
  // KLU takes its pattern as pointers to non-const but does not write to it.
  handles_->symbolic = klu_analyze(pattern.order, const_cast<int*>(pattern.column_start.data()),
                                   const_cast<int*>(pattern.row.data()), &handles_->common);
  if (handles_->symbolic == nullptr && handles_->common.status != KLU_SINGULAR) {
    throw base::LibraryError("klu_analyze", handles_->common.status,
                             "the pattern is invalid, or memory has run out");
  }
}

void Klu::HandlesDeleter::operator()(Handles* handles) const noexcept {
  delete handles;
}

bool Klu::factorize(const SparseMatrix& matrix) {
  assert(matrix.order == handles_->order);
  auto* start = const_cast<int*>(matrix.column_start.data());
  auto* row = const_cast<int*>(matrix.row.data());
  auto* value = const_cast<double*>(matrix.value.data());
  Handles& h = *handles_;
  if (h.symbolic == nullptr) return false;
  if (h.numeric != nullptr) {
    // Keep the pivots while they do not grow: pivot growth below 1e-8 means that eight digits are lost.
    if (klu_refactor(start, row, value, h.symbolic, h.numeric, &h.common) == 1 && h.common.status == KLU_OK &&
        klu_rgrowth(start, row, value, h.symbolic, h.numeric, &h.common) == 1 && h.common.rgrowth > 1e-8) {
      return true;
    }
    klu_free_numeric(&h.numeric, &h.common);
  }
  h.numeric = klu_factor(start, row, value, h.symbolic, &h.common);
  if (h.numeric == nullptr && h.common.status < 0) {
    throw base::LibraryError("klu_factor", h.common.status, "the matrix is invalid, or memory has run out");
  }
  return h.numeric != nullptr && h.common.status == KLU_OK;
}

void Klu::solve(Eigen::Ref<Eigen::VectorXd> b) const {
  assert(handles_->numeric != nullptr && b.size() == handles_->order);
  klu_solve(handles_->symbolic, handles_->numeric, handles_->order, 1, b.data(), &handles_->common);
}

namespace {

/// +1 or -1: whether a permutation of 0 ... n-1 has an even or odd number of swaps.
int parity(const int* permutation, int n) {
  std::vector<bool> seen(static_cast<std::size_t>(n), false);
  int sign = 1;
  for (int first = 0; first < n; ++first) {
    // A cycle of k elements is k - 1 swaps.
    int length = 0;
    for (int i = first; !seen[static_cast<std::size_t>(i)]; i = permutation[i]) {
      seen[static_cast<std::size_t>(i)] = true;
      ++length;
    }
    if (length > 0 && length % 2 == 0) sign = -sign;
  }
  return sign;
}

}  // namespace

// P (R \ A) Q = L U + F with positive row scales R, unit L, and F above the diagonal blocks.
int Klu::determinant_sign() const {
  const Handles& h = *handles_;
  assert(h.numeric != nullptr);
  int sign = parity(h.numeric->Pnum, h.order) * parity(h.symbolic->Q, h.order);
  const auto* diagonal = static_cast<const double*>(h.numeric->Udiag);
  for (int i = 0; i < h.order; ++i) {
    if (diagonal[i] < 0.0) sign = -sign;
  }
  return sign;
}

double Klu::reciprocal_condition() const {
  klu_rcond(handles_->symbolic, handles_->numeric, &handles_->common);
  return handles_->common.rcond;
}

}  // namespace snare::numerics
