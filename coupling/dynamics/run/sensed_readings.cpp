#include "coupling/dynamics/run/sensed_readings.hpp"

#include "base/index.hpp"
#include "coupling/dynamics/model/vector_memory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::coupling {

using Eigen::Vector3d;

namespace {

/// Of an output interval: times that differ by less are one.
constexpr double same_output = 1e-9;

}  // namespace

SensedReadings::SensedReadings(const Motion& motion, double output_interval)
    : output_interval_(output_interval) {
  for (const SensedSignal& s : motion.sensed) {
    signals_.emplace_back().what = &s;
    signals_.back().sight = s.make(motion);
  }
}

SensedReadings::Told SensedReadings::told(const Signal& signal, long reading) const {
  const double time =
      std::max(0.0, static_cast<double>(reading) * signal.what->interval - signal.what->delay);
  const double outputs = time / output_interval_;
  const double whole = std::floor(outputs + same_output);
  const double share = outputs - whole;
  return {std::lround(whole), share > same_output ? share : 0.0};
}

double SensedReadings::next_look(const Signal& signal) const {
  const Told t = told(signal, signal.seen);
  return static_cast<double>(t.output + (signal.first ? 1 : 0)) * output_interval_;
}

double SensedReadings::limit(double time) const {
  double first = std::numeric_limits<double>::infinity();
  for (const Signal& s : signals_) {
    for (const double next : {next_look(s), static_cast<double>(s.read) * s.what->interval})
      if (next > time) first = std::min(first, next);
  }
  return first;
}

void SensedReadings::cross_break(double time, const Sampler& sample) {
  const double until = time + same_output * output_interval_;
  std::optional<MotionSample> now;
  for (Signal& s : signals_) {
    while (next_look(s) <= until) {
      if (!now) now = sample();
      const Told t = told(s, s.seen);
      const Vector3d value = s.sight(*now);
      if (t.share > 0.0 && !s.first) {
        s.first = value;
        continue;
      }
      Vector3d reading = s.first ? Vector3d(*s.first + t.share * (value - *s.first)) : value;
      if (s.what->noise) reading += s.what->noise(s.seen);
      s.waiting.push_back(reading);
      s.first.reset();
      ++s.seen;
    }
    while (!s.waiting.empty() && static_cast<double>(s.read) * s.what->interval <= until) {
      s.last = s.waiting.front();
      s.waiting.pop_front();
      ++s.read;
    }
  }
}

const Vector3d& SensedReadings::last(int signal) const {
  return signals_[base::at(signal)].last;
}

void SensedReadings::save_state(std::vector<double>& memory) const {
  for (const Signal& s : signals_) {
    memory.insert(memory.end(),
                  {static_cast<double>(s.seen), static_cast<double>(s.read), s.first ? 1.0 : 0.0});
    put_vector(memory, s.first.value_or(Vector3d::Zero()));
    put_vector(memory, s.last);
    memory.push_back(static_cast<double>(s.waiting.size()));
    for (const Vector3d& w : s.waiting) put_vector(memory, w);
  }
}

void SensedReadings::restore_state(std::span<const double>& memory) {
  for (Signal& s : signals_) {
    s.seen = std::lround(numerics::take(memory));
    s.read = std::lround(numerics::take(memory));
    const bool half = numerics::take(memory) != 0.0;
    const Vector3d first = take_vector(memory);
    s.first = half ? std::optional(first) : std::nullopt;
    s.last = take_vector(memory);
    s.waiting.clear();
    const double count = numerics::take(memory);
    for (double k = 0.0; k < count && !memory.empty(); ++k) s.waiting.push_back(take_vector(memory));
  }
}

}  // namespace snare::coupling
