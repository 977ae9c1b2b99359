#include "numerics/sundials.hpp"

#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>

namespace snare::numerics {

void check(int code, const std::string& function) {
  if (code < 0)
    throw base::LibraryError(function, code, "the library refused its input or could not be set up");
}

SunMatrix make_matrix(const SparseMatrix& pattern, SUNContext context) {
  SunMatrix matrix(made(SUNSparseMatrix(pattern.order, pattern.order,
                                        static_cast<sunindextype>(pattern.row.size()), CSC_MAT, context),
                        "SUNSparseMatrix"));
  copy(pattern, matrix.get());
  return matrix;
}

void copy(const SparseMatrix& from, SUNMatrix to) {
  std::copy(from.column_start.begin(), from.column_start.end(), SUNSparseMatrix_IndexPointers(to));
  std::copy(from.row.begin(), from.row.end(), SUNSparseMatrix_IndexValues(to));
  std::copy(from.value.begin(), from.value.end(), SUNSparseMatrix_Data(to));
}

}  // namespace snare::numerics
