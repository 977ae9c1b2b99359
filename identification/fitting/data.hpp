#pragma once

#include "identification/fitting/model.hpp"
#include "identification/fitting/noise.hpp"

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

namespace snare::identification {

/// Key of the number that moves the pusher along the chord.
inline constexpr const char* place_key = "contact_position.shift_mm";

/// Where the pusher stands in one test, at any speed, known to a standard deviation.     theory.md (I.14)
struct Placing {
  std::vector<std::size_t> series;  ///< of the model, those pushed from this place
  double sigma = 0.0;               ///< of the place about the declared one [m], > 0
  std::vector<Eigen::VectorXd> by;  ///< derivative of the forces by the place, one for each of `series` [N/m]
};

/// What the readings say of a place.
struct PlaceEstimate {
  std::vector<std::string> series;  ///< names of those pushed from there
  double sigma = 0.0;               ///< declared [m]
  double shift = 0.0;               ///< from the declared place [m]
  double standard_error = 0.0;      ///< [m]
};

/// Measured forces of some of a model's series, with what is known of their errors: the noise V_n of every
/// series and the error of every place,
///   V = V_n + sum_c sigma_c^2 g_c g_c^T,   g_c = dF / d(place c).                          theory.md (I.14)
struct Data {
  std::vector<std::size_t> series;        ///< which of the model's
  std::vector<Eigen::VectorXd> measured;  ///< of every series of the model [N]
  Noise noise;                            ///< of every series of the model
  std::vector<Placing> placings;          ///< of tests whose place is not exact; none until find_placings()

  /// Whitened numbers of one series: its readings, or four where only a fit was published.
  [[nodiscard]] Eigen::Index rows_of(std::size_t of_series) const {
    return noise.rows(of_series, measured[of_series].size());
  }
  [[nodiscard]] Eigen::Index rows() const;
  /// Whether all series are published fits.
  [[nodiscard]] bool published() const;
  /// Forces as they are read [N], by columns, one matrix a series of the model.
  using Forces = std::function<Eigen::MatrixXd(std::size_t of_series)>;
  /// V^(-1/2) of `columns` columns of forces [-], the data's series one below the other.
  [[nodiscard]] Eigen::MatrixXd whiten(const Forces& forces, Eigen::Index columns) const;
  /// (measured - computed), whitened [-], likewise.
  [[nodiscard]] Eigen::VectorXd residual(const Evaluation& evaluation) const;
  /// Whitened derivatives [1 over the unit of the coordinate], likewise.
  [[nodiscard]] Eigen::MatrixXd jacobian(const Evaluation& evaluation) const;
  /// The forces less what errors of places have brought, as far as these forces tell: V_n V^-1 f [N], one
  /// matrix for each of the data's series.
  [[nodiscard]] std::vector<Eigen::MatrixXd> placed(const Forces& forces, Eigen::Index columns) const;

  /// Errors of the places [m] at the optimum of a fit to these data, in the order of `placings`. optimum:
  /// with the derivatives by the fitted coordinates; covariance: of these.
  [[nodiscard]] std::vector<PlaceEstimate> places(const Model& model, const Evaluation& optimum,
                                                  const Eigen::MatrixXd& covariance) const;

 private:
  /// Visits the rows of the R2 of published fits.
  void for_published(const std::function<void(std::size_t of_series, Eigen::Index row)>& visit) const;
  /// A placing of which series are among the data, in their rows.
  struct Direction;
  [[nodiscard]] std::vector<Direction> directions() const;
};

/// The placings of a model's series, their derivatives with these settings. Series of one test share a place,
/// the largest standard deviation counts. None where all places are exact, and where the model cannot be
/// computed.
[[nodiscard]] std::vector<Placing> find_placings(const Model& model, const std::vector<Setting>& settings,
                                                 const Parameter& place);

}  // namespace snare::identification
