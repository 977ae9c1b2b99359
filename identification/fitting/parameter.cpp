#include "identification/fitting/parameter.hpp"

#include <cmath>

namespace snare::identification {

double Parameter::value(double declared, double c) const {
  switch (parametrisation) {
    case Parametrisation::ratio:
      return declared * std::exp(c);
    case Parametrisation::shift:
      return declared + c;
    case Parametrisation::magnitude:
      return std::exp(c);
  }
  return declared;
}

double Parameter::shown(double declared, double c) const {
  return (reports_change ? c : value(declared, c)) / unit_size;
}

double Parameter::coordinate(double declared, double v) const {
  switch (parametrisation) {
    case Parametrisation::ratio:
      return std::log(v / declared);
    case Parametrisation::shift:
      return v - declared;
    case Parametrisation::magnitude:
      return std::log(v);
  }
  return 0.0;
}

}  // namespace snare::identification
