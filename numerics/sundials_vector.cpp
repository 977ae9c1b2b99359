// The operations on serial vectors that the integrator spends its time in, as loops that the compiler makes
// use of vector registers for: SUNDIALS' own go element by element. Clones of a vector have the operations of
// the vector.

#include "numerics/ida_callbacks.hpp"
#include "numerics/sundials.hpp"

#include <Eigen/Core>

#include <cmath>

namespace snare::numerics {

namespace {

extern "C" {

void snare_linear_sum(realtype a, N_Vector x, realtype b, N_Vector y, N_Vector z) {
  if (b == 1.0) {
    map(z) = a * map(x) + map(y);
  } else {
    map(z) = a * map(x) + b * map(y);
  }
}

void snare_scale(realtype c, N_Vector x, N_Vector z) {
  map(z) = c * map(x);
}

void snare_fill(realtype c, N_Vector z) {
  map(z).setConstant(c);
}

realtype snare_mean_norm(N_Vector x, N_Vector weight) {
  return std::sqrt(map(x).cwiseProduct(map(weight)).squaredNorm() / static_cast<double>(N_VGetLength(x)));
}

// `id` is one for what counts and zero for the rest.
realtype snare_masked_mean_norm(N_Vector x, N_Vector weight, N_Vector id) {
  return std::sqrt(map(x).cwiseProduct(map(weight)).cwiseProduct(map(id)).squaredNorm() /
                   static_cast<double>(N_VGetLength(x)));
}

// z = sum_k c_k x_k; z may be the first x.
int snare_linear_combination(int count, realtype* c, N_Vector* x, N_Vector z) {
  if (count == 1) {
    map(z) = c[0] * map(x[0]);
    return 0;
  }
  map(z) = c[0] * map(x[0]) + c[1] * map(x[1]);
  for (int k = 2; k < count; ++k) map(z) += c[k] * map(x[k]);
  return 0;
}
}

}  // namespace

SunVector view(Eigen::VectorXd& v, SUNContext context) {
  SunVector vector(made(N_VMake_Serial(v.size(), v.data(), context), "N_VMake_Serial"));
  constexpr Eigen::Index short_vector = 64;  // gains nothing, and keeps SUNDIALS' order of summation
  if (v.size() < short_vector) return vector;
  vector->ops->nvlinearsum = snare_linear_sum;
  vector->ops->nvscale = snare_scale;
  vector->ops->nvconst = snare_fill;
  vector->ops->nvwrmsnorm = snare_mean_norm;
  vector->ops->nvwrmsnormmask = snare_masked_mean_norm;
  vector->ops->nvlinearcombination = snare_linear_combination;
  return vector;
}

}  // namespace snare::numerics
