#pragma once

#include "coupling/statics/push_solver.hpp"
#include "identification/fitting/experiment.hpp"
#include "identification/fitting/legs.hpp"
#include "identification/fitting/record_map.hpp"

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace snare::identification {

/// What a model says the machine records, at the displacements of a series.
struct Prediction {
  coupling::ExtrapolatedCurve curve;  ///< at the travels after first touch, in order
  std::vector<double> force;          ///< recorded force [N], one a displacement that was reached
  TrueForce wire;                     ///< of which it is the record, likewise
  /// d wire.force / d number: a row a displacement, a column a variation asked for.
  Eigen::MatrixXd force_by;
  std::vector<double> mount_pull;  ///< of the wire on the left mount along the chord, one a displacement [N]
  ReadingModel reading;            ///< as it was predicted with
  std::size_t before_touch = 0;    ///< points that lie before first touch: they have no entry in `curve`
};

/// Predictions of every series of which copies share what they hold: those of a million readings are large.
class SharedPredictions {
 public:
  SharedPredictions() = default;
  SharedPredictions(std::vector<Prediction> predictions)
      : predictions_(std::make_shared<const std::vector<Prediction>>(std::move(predictions))) {}
  operator const std::vector<Prediction>&() const { return get(); }
  /// All of them, one a series; empty: nothing was predicted.
  [[nodiscard]] const std::vector<Prediction>& get() const {
    static const std::vector<Prediction> none;
    return predictions_ ? *predictions_ : none;
  }
  [[nodiscard]] bool empty() const { return get().empty(); }       ///< nothing was predicted
  [[nodiscard]] std::size_t size() const { return get().size(); }  ///< of series
  const Prediction& operator[](std::size_t series) const { return get()[series]; }
  [[nodiscard]] auto begin() const { return get().begin(); }
  [[nodiscard]] auto end() const { return get().end(); }

 private:
  std::shared_ptr<const std::vector<Prediction>> predictions_;
};

/// Readings of a leg beyond which a record may be thinned, see PredictionOptions.
inline constexpr std::size_t dense_leg = 120;

/// What a prediction computes besides the force, how densely, and who watches it.
struct PredictionOptions {
  std::vector<double> shapes_at;                    ///< travels of which to keep the wire's shape [m]
  bool examine_out_of_plane = false;                ///< see coupling::PushOptions
  bool examine_rates = false;                       ///< see coupling::PushOptions
  std::function<bool(double travel)> progress;      ///< see coupling::PushOptions
  std::function<bool()> stop;                       ///< see coupling::PushOptions
  std::vector<coupling::PushVariation> variations;  ///< numbers of the test to differentiate by
  /// Compute dense records (more than 120 readings on a leg of the path) at 60 points a leg and interpolate
  /// by cubics; the readings of a leg then count by their displacement, whatever their order.
  bool thin = false;
};

/// Predicts one series at its displacements. A displacement before first touch reads no force; touch comes
/// where the displacement first exceeds the offset.
[[nodiscard]] Prediction predict(const Series& series, const SolverSettings& solver,
                                 const ReadingModel& reading = {}, const PredictionOptions& options = {});

/// Every series, in parallel; the result does not depend on the number of threads.
[[nodiscard]] std::vector<Prediction> predict_all(const std::vector<Series>& series,
                                                  const SolverSettings& solver,
                                                  const ReadingModel& reading = {},
                                                  const std::vector<PredictionOptions>& options = {});

/// What stands for the readings of a series: the readings themselves, or the published law [N].
/// Empty for a series that only asks for a prediction.
[[nodiscard]] std::vector<double> measured_force(const Series& series);

/// Misfit of predicted and measured force [N] over the points that were reached.
struct Misfit {
  double rmse = 0.0;     ///< [N]
  double nrmse = 0.0;    ///< rmse over the range of the measured force [-]
  double largest = 0.0;  ///< largest |difference| [N]
};
/// Both [N], in the order of the readings; compared as far as the shorter one goes.
[[nodiscard]] Misfit misfit(const std::vector<double>& measured, const std::vector<double>& predicted);

}  // namespace snare::identification
