#include "results/motion_record.hpp"

#include "base/index.hpp"

#include <algorithm>

namespace snare::results {

std::vector<FinishedMotion> finished_motions(const scenario::WireMotions& motions,
                                             const std::vector<MotionRecord>& records) {
  std::vector<FinishedMotion> finished;
  finished.reserve(records.size());
  for (const MotionRecord& record : records)
    finished.push_back({motions.runs[finished.size()], record.samples, record.result});
  return finished;
}

bool left_undone(const std::vector<scenario::NamedMotion>& motions,
                 const std::vector<MotionRecord>& records) {
  return records.size() < motions.size() || std::ranges::any_of(records, [](const MotionRecord& r) {
           return r.result.report.termination == numerics::Termination::interrupted;
         });
}

Touches touches_of(const coupling::MotionResult& result, std::size_t contact) {
  using Kind = coupling::MotionEvent::Kind;
  Touches touches;
  for (const coupling::MotionEvent& e : result.events) {
    if (static_cast<std::size_t>(e.contact) != contact) continue;
    if (e.kind == Kind::touch && touches.count++ == 0) touches.first = e.time;
    if (e.kind == Kind::lift_off) touches.last_lift_off = e.time;
  }
  return touches;
}

std::size_t most_points(const FinishedMotion& run, std::size_t contact) {
  std::size_t most = 0;
  for (const coupling::MotionSample& s : run.samples)
    most = std::max(most, s.contacts[contact].points.size());
  return most;
}

double real_time_factor(const coupling::MotionResult& result) {
  return result.wall_seconds > 0.0 ? result.report.time / result.wall_seconds : 0.0;
}

std::vector<scenario::Swing> swings_of(const scenario::WireMotions& motions, const FinishedMotion& run) {
  if (!motions.swinging) return {};
  const auto [a, joint] = *motions.swinging;
  const multibody::ElasticArm& arm = run.asked.motion.arms[base::at(a)].arm;
  const int velocity = arm.tree.body(arm.joints[base::at(joint)].body).v_index;
  std::vector<scenario::SwingSample> samples;
  for (const coupling::MotionSample& s : run.samples) {
    const multibody::ArmState& state = s.arms[base::at(a)].state;
    samples.push_back(
        {s.time, multibody::deflection(arm, state, joint), state.v[velocity] - state.motor_rate[joint]});
  }
  return scenario::swings(samples);
}

}  // namespace snare::results
