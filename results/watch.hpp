#pragma once

#include <functional>
#include <string>

namespace snare::results {

/// Who looks at long work from outside. Either function may be empty; both may be called from any thread.
struct Watch {
  std::function<void(const std::string& stage)> progress;  ///< what is under way, for a person
  std::function<bool()> stop;  ///< true: the work ends at the next point where it can

  /// Tells a stage where somebody listens.
  void say(const std::string& stage) const {
    if (progress) progress(stage);
  }
  [[nodiscard]] bool stopped() const { return stop && stop(); }  ///< somebody wants the work to end
};

}  // namespace snare::results
