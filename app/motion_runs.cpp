#include "app/motion_runs.hpp"

#include "app/interruption.hpp"
#include "app/motion_checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

namespace snare::app {

namespace {

using coupling::MotionResult;
using coupling::MotionSample;
using scenario::NamedMotion;

class Runs {
 public:
  Runs(const std::vector<NamedMotion>& motions, const CheckpointPolicy& policy, Console& console)
      : motions_(motions), policy_(policy), console_(console), written_(Clock::now()) {
    LoadedCheckpoint loaded = read_motion_checkpoint(policy.file, policy.input);
    if (!loaded.refusal.empty()) console.complain(loaded.refusal);
    if (!loaded.progress || loaded.progress->finished.size() >= motions.size()) return;
    progress_ = std::move(*loaded.progress);
    console.say(fmt::format("goes on from {}: {} at {:.6g} s", policy.file.string(),
                            motions[progress_.finished.size()].name,
                            progress_.state ? progress_.state->time : 0.0));
  }

  [[nodiscard]] std::vector<MotionRecord> all() {
    bool stopped = false;
    while (!stopped && progress_.finished.size() < motions_.size()) stopped = !run_next();
    if (!stopped && !kept_) {
      std::error_code ignored;
      std::filesystem::remove(policy_.file, ignored);
    }
    return std::move(progress_.finished);
  }

  /// Called while a run is under way, from another thread. Writes the last checkpoint; says what it is.
  [[nodiscard]] std::string keep() {
    const std::scoped_lock lock(mutex_);
    if (!progress_.state && progress_.finished.empty()) return "nothing was finished, nothing is kept";
    write();
    return fmt::format("the state at {:.6g} s is kept in {}; the same command goes on from there",
                       progress_.state ? progress_.state->time : 0.0, policy_.file.string());
  }

 private:
  using Clock = std::chrono::steady_clock;

  static double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }

  /// False when it was interrupted.
  bool run_next() {
    const NamedMotion& asked = motions_[progress_.finished.size()];
    const double duration = asked.options.duration;
    const std::optional<coupling::MotionState> from = progress_.state;
    const double begun = from ? from->time : 0.0;
    std::vector<MotionSample> samples = progress_.samples;
    const auto begin = Clock::now();
    coupling::MotionOptions options = asked.options;
    options.stop = interrupted;
    MotionResult result = coupling::simulate(
        asked.motion, options,
        [&](const MotionSample& s) {
          samples.push_back(s);
          const double share = (s.time - begun) / (duration - begun);
          console_.progress(fmt::format("{}: {:.3f} of {:.3f} s, {:.0f} s to go", asked.name, s.time,
                                        duration,
                                        share > 0.0 ? seconds_since(begin) * (1.0 - share) / share : 0.0));
          return false;
        },
        from ? &*from : nullptr,
        [&](const coupling::MotionState& state) {
          const std::scoped_lock lock(mutex_);
          progress_.state = state;
          const auto known = static_cast<std::ptrdiff_t>(progress_.samples.size());
          progress_.samples.insert(progress_.samples.end(), samples.begin() + known, samples.end());
          if (seconds_since(written_) >= policy_.wall_time) write();
        });
    console_.end_progress();
    const bool stopped = result.report.termination == numerics::Termination::interrupted;
    const bool stalled = result.report.termination == numerics::Termination::stalled;
    const std::scoped_lock lock(mutex_);
    kept_ = stalled && progress_.state && progress_.finished.size() + 1 == motions_.size();
    if (!result.report.usable()) {
      console_.complain(
          fmt::format("{}: {} (what was reached is kept{})", asked.name, result.report.message,
                      stopped ? "; the same command goes on from the last checkpoint"
                      : kept_ ? "; with a smaller solver.least_advance_s the same command goes on from there"
                      : stalled ? "; a smaller solver.least_advance_s gives it more"
                                : ""));
    }
    if (stopped || kept_)
      write();  // before the motion counts as finished: it continues from its last checkpoint
    progress_.finished.push_back({std::move(samples), std::move(result)});
    if (stopped) return false;
    progress_.samples.clear();
    progress_.state.reset();
    if (!kept_ && seconds_since(written_) >= policy_.wall_time) write();
    return true;
  }

  /// A checkpoint that cannot be written costs the way back to it, not the run.
  void write() {
    written_ = Clock::now();
    try {
      write_motion_checkpoint(policy_.file, policy_.input, progress_);
      failed_ = false;
    } catch (const std::system_error& error) {
      if (!failed_)
        console_.complain(fmt::format("{}; the run goes on without this checkpoint", error.what()));
      failed_ = true;
    }
  }

  const std::vector<NamedMotion>& motions_;
  const CheckpointPolicy& policy_;
  Console& console_;
  MotionProgress progress_;
  std::mutex mutex_;           // of progress_, which an interruption looks at from another thread
  Clock::time_point written_;  // when a checkpoint was
  bool failed_ = false;        // the last checkpoint could not be written
  bool kept_ = false;          // the last of the motions has stalled; its checkpoint stays
};

}  // namespace

std::vector<MotionRecord> run_motions(const std::vector<scenario::NamedMotion>& motions,
                                      const CheckpointPolicy& policy, Console& console) {
  Runs runs(motions, policy, console);
  const KeepWhenInterrupted keeping([&runs] { return runs.keep(); }, std::nullopt);
  return runs.all();
}

ExitStatus status_of(const std::vector<MotionRecord>& records) {
  const bool fine = std::all_of(records.begin(), records.end(),
                                [](const MotionRecord& r) { return r.result.report.usable(); });
  return fine ? ExitStatus::done : ExitStatus::solver_stopped;
}

}  // namespace snare::app
