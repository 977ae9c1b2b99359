#include "benchmarks/peers/cholmod.hpp"

#include "base/errors.hpp"

#include <cholmod.h>

#include <cassert>

namespace snare::benchmarks {

using numerics::SparseMatrix;

namespace {

/// CHOLMOD's view of our lower triangle; CHOLMOD does not write to it.
cholmod_sparse view(const SparseMatrix& lower) {
  cholmod_sparse m{};
  m.nrow = m.ncol = static_cast<std::size_t>(lower.order);
  m.nzmax = lower.row.size();
  m.p = const_cast<int*>(lower.column_start.data());
  m.i = const_cast<int*>(lower.row.data());
  m.x = const_cast<double*>(lower.value.data());
  m.stype = -1;
  m.itype = CHOLMOD_INT;
  m.xtype = CHOLMOD_REAL;
  m.dtype = CHOLMOD_DOUBLE;
  m.sorted = 1;
  m.packed = 1;
  return m;
}

}  // namespace

struct Cholmod::Handles {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_dense* x = nullptr;
  cholmod_dense* y = nullptr;
  cholmod_dense* e = nullptr;
  int order = 0;

  Handles() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_ll = 0;
  }
  ~Handles() {
    if (factor != nullptr) cholmod_free_factor(&factor, &common);
    for (cholmod_dense** d : {&x, &y, &e}) {
      if (*d != nullptr) cholmod_free_dense(d, &common);
    }
    cholmod_finish(&common);
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
};

Cholmod::Cholmod(const SparseMatrix& lower, Ordering ordering) : handles_(new Handles) {
  Handles& h = *handles_;
  h.order = lower.order;
  h.common.nmethods = 1;
  h.common.method[0].ordering = ordering == Ordering::natural ? CHOLMOD_NATURAL : CHOLMOD_AMD;
  h.common.postorder = ordering == Ordering::natural ? 0 : 1;
  cholmod_sparse m = view(lower);
  h.factor = cholmod_analyze(&m, &h.common);
  if (h.factor == nullptr)
    throw base::LibraryError("cholmod_analyze", h.common.status, "the pattern is invalid");
}

void Cholmod::HandlesDeleter::operator()(Handles* handles) const noexcept {
  delete handles;
}

bool Cholmod::factorize(const SparseMatrix& lower) {
  assert(lower.order == handles_->order);
  cholmod_sparse m = view(lower);
  cholmod_factorize(&m, handles_->factor, &handles_->common);
  return handles_->common.status == CHOLMOD_OK;
}

void Cholmod::solve(Eigen::Ref<Eigen::VectorXd> b) const {
  Handles& h = *handles_;
  cholmod_dense right{};
  right.nrow = right.d = right.nzmax = static_cast<std::size_t>(h.order);
  right.ncol = 1;
  right.x = b.data();
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, h.factor, &right, nullptr, &h.x, nullptr, &h.y, &h.e, &h.common);
  b = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(h.x->x), h.order);
}

int Cholmod::negative_pivots() const {
  const cholmod_factor& f = *handles_->factor;
  const auto* start = static_cast<const int*>(f.p);
  const auto* values = static_cast<const double*>(f.x);
  int count = 0;
  for (int j = 0; j < handles_->order; ++j) count += values[start[j]] < 0.0 ? 1 : 0;
  return count;
}

}  // namespace snare::benchmarks
