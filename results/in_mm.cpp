#include "results/in_mm.hpp"

#include "base/in_unit.hpp"
#include "base/units.hpp"

namespace snare::results {

double in_mm(double metres) {
  return base::in_unit(metres, base::mm);
}

std::vector<double> in_mm(std::vector<double> metres) {
  for (double& v : metres) v = in_mm(v);
  return metres;
}

double in_degrees(double radians) {
  return base::in_unit(radians, base::degree);
}

}  // namespace snare::results
