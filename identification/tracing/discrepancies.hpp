#pragma once

#include "identification/fitting/least_squares.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// An unknown smooth function of one variable that all series share, which the model lacks: a Gaussian
/// process on hats at even stations, Matern 5/2 with lengths of 0.15, 0.3 and 0.6 of the variable's range.
/// Its constant and its straight part are left out, which effects of the catalogue have (offsets, gains,
/// zeros).                                                                                 theory.md (I.37)
struct Discrepancy {
  /// What the function hangs on: "force", "travel", "time", "place" (along the wire), "leg" (up or down),
  /// "series" (each its own factor), or "other" (a function of its own for each series).
  std::string variable;
  /// Whitened change of the readings by independent normal numbers, a reading a row, one matrix a length; its
  /// root mean square over the readings is 1.
  std::vector<Eigen::MatrixXd> columns;
};

/// Those that these series may show, about a fit with its evaluation; a variable may have several functions.
/// With one series only "other": no function is shared. Functions whose derivatives the model does not have
/// are left out.
[[nodiscard]] std::vector<Discrepancy> discrepancies(const Model& model, const Data& data, const Fit& fit);

}  // namespace snare::identification
