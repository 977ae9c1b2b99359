#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace snare::identification {

/// What a long search tells of itself, and whether it is to go on.
class Progress {
 public:
  /// observer: sees every stage; false stops. May be empty.
  explicit Progress(std::function<bool(const std::string& stage)> observer)
      : observer_(std::move(observer)) {}

  /// Begins a stage; false once the observer has said so.
  [[nodiscard]] bool go_on(const std::string& stage) {
    if (!interrupted_ && observer_ && !observer_(stage)) interrupted_ = true;
    return !interrupted_;
  }
  [[nodiscard]] bool interrupted() const { return interrupted_; }

  /// Books the time since the last call, or since the beginning.
  void clock(const std::string& what) {
    const auto now = std::chrono::steady_clock::now();
    seconds_.emplace_back(what, std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }
  /// What was booked, by stage in its order [s].
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

 private:
  std::function<bool(const std::string&)> observer_;
  bool interrupted_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace snare::identification
