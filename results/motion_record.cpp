#include "results/motion_record.hpp"

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

bool left_undone(const std::vector<scenario::NamedMotion>& motions, const std::vector<MotionRecord>& records) {
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
  for (const coupling::MotionSample& s : run.samples) most = std::max(most, s.contacts[contact].points.size());
  return most;
}

double real_time_factor(const coupling::MotionResult& result) {
  return result.wall_seconds > 0.0 ? result.report.time / result.wall_seconds : 0.0;
}

double joint_deflection(const coupling::Motion& motion, const coupling::MotionSample& sample, int joint) {
  return multibody::deflection(motion.arms.front().arm, sample.arms.front().state, joint);
}

double ArmRecord::time() const {
  return history.samples.empty() ? 0.0 : history.samples.back().time;
}

double ArmRecord::real_time_factor() const {
  return wall_seconds > 0.0 ? time() / wall_seconds : 0.0;
}

}  // namespace snare::results
