#include "numerics/klu.hpp"

#include "numerics/errors.hpp"

#include <klu.h>

#include <cassert>

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

Klu::Klu(const SparseMatrix& pattern) : handles_(std::make_unique<Handles>()) {
  handles_->order = pattern.order;
  // KLU takes its pattern as pointers to non-const but does not write to it.
  handles_->symbolic = klu_analyze(pattern.order, const_cast<int*>(pattern.column_start.data()),
                                   const_cast<int*>(pattern.row.data()), &handles_->common);
  if (handles_->symbolic == nullptr) {
    throw LibraryError("klu_analyze", handles_->common.status, "the pattern is structurally singular or invalid");
  }
}

Klu::~Klu() = default;
Klu::Klu(Klu&&) noexcept = default;
Klu& Klu::operator=(Klu&&) noexcept = default;

bool Klu::factorize(const SparseMatrix& matrix) {
  assert(matrix.order == handles_->order);
  auto* start = const_cast<int*>(matrix.column_start.data());
  auto* row = const_cast<int*>(matrix.row.data());
  auto* value = const_cast<double*>(matrix.value.data());
  Handles& h = *handles_;
  if (h.numeric != nullptr) {
    // Keep the pivots while they do not grow: pivot growth below 1e-8 means that eight digits are lost.
    if (klu_refactor(start, row, value, h.symbolic, h.numeric, &h.common) == 1 && h.common.status == KLU_OK &&
        klu_rgrowth(start, row, value, h.symbolic, h.numeric, &h.common) == 1 && h.common.rgrowth > 1e-8) {
      return true;
    }
    klu_free_numeric(&h.numeric, &h.common);
  }
  h.numeric = klu_factor(start, row, value, h.symbolic, &h.common);
  return h.numeric != nullptr && h.common.status == KLU_OK;
}

void Klu::solve(Eigen::Ref<Eigen::VectorXd> b) const {
  assert(handles_->numeric != nullptr && b.size() == handles_->order);
  klu_solve(handles_->symbolic, handles_->numeric, handles_->order, 1, b.data(), &handles_->common);
}

double Klu::reciprocal_condition() const {
  klu_rcond(handles_->symbolic, handles_->numeric, &handles_->common);
  return handles_->common.rcond;
}

}  // namespace snare::numerics
