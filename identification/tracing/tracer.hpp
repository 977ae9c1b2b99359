#pragma once

#include "identification/tracing/base_fit.hpp"
#include "identification/tracing/hypotheses.hpp"
#include "identification/tracing/progress.hpp"
#include "identification/tracing/trace.hpp"
#include "identification/tracing/trace_input.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// Thrown where `TraceOptions::stop` has ended curves.
struct Stopped {};

/// A trace under way: tracer.cpp has the search, tracer_verdict.cpp the verdict, the intervals and the next
/// experiment.
class Tracer {
 public:
  Tracer(const Experiment& experiment, const TraceOptions& options, Division series);
  /// The whole trace, or what was finished when it was stopped. Throws Stopped.
  Trace run();

 private:
  [[nodiscard]] bool only_fitted() const { return options_.most_effects == 0; }
  void look_at_base();
  void tell_part() const;
  void look_for_effects();
  void add_effects();
  [[nodiscard]] bool beyond_section(const Fit& fit) const;
  [[nodiscard]] std::vector<Setting> begun_anew() const;
  [[nodiscard]] bool accept();
  void drop_unneeded();
  [[nodiscard]] bool needed(std::size_t which, double inflation, Fit& without);
  void conclude();
  void select();
  void reject();
  void find_findings();
  [[nodiscard]] bool decided() const;
  [[nodiscard]] bool numbers_open() const;
  void widen_for_serial_noise();
  [[nodiscard]] bool serial_noise_does() const;
  void compare_models();
  void weigh();
  void average_intervals();
  void find_intervals();
  void propose();
  [[nodiscard]] ModelError error_of(const Fit& fit, SharedPredictions& predictions) const;
  [[nodiscard]] std::vector<Setting> with_places(const Fit& fit) const;
  [[nodiscard]] const std::vector<ChannelFunction>& functions();
  [[nodiscard]] std::vector<ChannelFunction> rivals();

  const Experiment& experiment_;
  const TraceOptions& options_;
  Trace result_;
  Progress progress_;
  Model model_;      // of the fitted series
  HeldOut heldout_;  // the others
  Model all_;        // of every series, on the mesh asked for
  Data data_;
  Fit base_;
  SharedPredictions base_predictions_;  // whole, until another model is chosen
  Fit current_;                         // with the effects added so far
  Fit final_;                           // what is selected
  Data final_data_;                     // with the autocorrelated noise of its residual
  ResidualTests tests_;                 // of current_
  std::vector<std::string> added_;      // effects, and the class of each
  std::vector<std::size_t> numbers_;    // of each
  std::vector<std::vector<std::string>> classes_;
  std::vector<ChannelFunction> functions_;  // of the base model's residual, once asked for
  std::vector<RoundFits> rounds_;           // in which an effect was added
  std::vector<FittedModel> models_;         // base model and refits with effects that make sense
};

}  // namespace snare::identification
