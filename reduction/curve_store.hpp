#pragma once

#include "base/files.hpp"
#include "numerics/report.hpp"
#include "reduction/wire_file.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::reduction {

/// Where a curve is taken: position of the pusher and slack of the wire [m].
struct CurvePlace {
  double position = 0.0;
  double slack = 0.0;
  // NOLINTNEXTLINE(modernize-use-nullptr): it is shown the 0 that the compiler compares with.
  friend auto operator<=>(const CurvePlace&, const CurvePlace&) = default;
};

/// The full wire's force as it is pushed through the store's travels. Dissipative wires are loaded to the end
/// of the travel and unloaded.
struct PushedCurve {
  std::vector<double> loading;  ///< force [N], one a travel
  /// On the way back, at the same travels; empty where nothing dissipates [N].
  std::vector<double> unloading;
  double discretisation_error = 0.0;  ///< largest estimate over the curve [N]
  double largest_strain = 0.0;        ///< of the wire [-]
  double dissipated = 0.0;            ///< by friction on the pusher over load and unload [J]
  bool complete = false;              ///< every travel was reached
  std::string stopped;                ///< why not
};

/// Told after every curve: finished and wanted ones. false stops the sampling.
using SamplingObserver = std::function<bool(std::size_t finished, std::size_t wanted)>;

/// Told what a journal that cannot be written suffers.
using JournalTrouble = std::function<void(const std::string& what)>;

/// Curves of one case of a wire, each solved once, in parallel, and journalled: a run that was killed
/// continues from the journal, and gives the same bytes, because numbers in it read back to the same doubles.
class CurveStore {
 public:
  /// travel: ascending from 0 [m]. journal: file to which finished curves are appended; none when empty. What
  /// it holds of the same case and settings is used; a torn last line and curves of other cases are passed
  /// over.
  /// trouble: is told once why the journal cannot be written; the curves are computed all the same.
  CurveStore(WireCase wire, const DistilSettings& settings, std::vector<double> travel,
             std::filesystem::path journal = {}, JournalTrouble trouble = {});

  /// Solves those of the places that are not known yet, by OpenMP over curves. Not usable when the observer
  /// stopped it or a curve did not reach the end of the travel; what was reached is kept.
  [[nodiscard]] numerics::SolveReport sample(const std::vector<CurvePlace>& places,
                                             const SamplingObserver& observer = {});

  /// A curve that was sampled; throws std::out_of_range for another place.
  [[nodiscard]] const PushedCurve& at(const CurvePlace& place) const { return curves_.at(place); }
  [[nodiscard]] const std::map<CurvePlace, PushedCurve>& curves() const noexcept { return curves_; }
  /// Travels of all curves, ascending from 0 [m].
  [[nodiscard]] const std::vector<double>& travel() const noexcept { return travel_; }
  [[nodiscard]] const WireCase& wire() const noexcept { return wire_; }
  [[nodiscard]] std::size_t solved() const noexcept { return solved_; }  ///< curves that were computed here
  /// Where the pusher stands for the same force in a symmetric wire: at most mid-span. position [m].
  [[nodiscard]] double folded(double position) const noexcept;

 private:
  [[nodiscard]] PushedCurve solve(const CurvePlace& place) const;
  void read_journal();
  /// Opened for what is to be appended; null where it cannot be, or could not before.
  [[nodiscard]] base::FileHandle open_journal();
  void give_up_journal();

  WireCase wire_;
  DistilSettings settings_;
  std::vector<double> travel_;
  std::filesystem::path journal_;  // empty: none
  JournalTrouble trouble_;
  std::string identity_;  // of the case and the settings: hash in hexadecimal digits
  std::map<CurvePlace, PushedCurve> curves_;
  std::size_t solved_ = 0;
};

}  // namespace snare::reduction
