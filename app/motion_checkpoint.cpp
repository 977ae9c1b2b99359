#include "app/motion_checkpoint.hpp"

#include "app/commands.hpp"
#include "base/archive.hpp"
#include "base/files.hpp"
#include "base/own_file.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <exception>
#include <limits>
#include <string_view>
#include <utility>

// What the structures consist of. A size that no longer fits says that a member came or went: it belongs here
// too.
namespace snare::multibody {
void fields(auto& a, RigidBodyState& s) {
  a(s.position)(s.orientation.coeffs())(s.velocity)(s.spin);
}
void fields(auto& a, ArmState& s) {
  static_assert(sizeof(ArmState) == 4 * sizeof(Eigen::VectorXd));
  a(s.q)(s.v)(s.motor)(s.motor_rate);
}
void fields(auto& a, ArmWork& w) {
  static_assert(sizeof(ArmWork) == 3 * sizeof(double));
  a(w.motors)(w.loads)(w.lost);
}
void fields(auto& a, Wrench& w) {
  a(w.moment)(w.force);
}
}  // namespace snare::multibody

namespace snare::numerics {
void fields(auto& a, IdaStatistics& s) {
  static_assert(sizeof(IdaStatistics) == 17 * sizeof(double));
  a(s.steps)(s.residuals)(s.jacobians)(s.factorizations)(s.analyses)(s.newton_iterations)(s.newton_failures)(
      s.error_test_failures)(s.restarts)(s.smallest_step)(s.largest_step)(s.integrands)(s.residual_seconds)(
      s.jacobian_seconds)(s.factor_seconds)(s.solve_seconds)(s.integrand_seconds);
}
void fields(auto& a, Effort& e) {
  static_assert(sizeof(Effort) == 2 * sizeof(double));
  a(e.evaluations)(e.since);
}
void fields(auto& a, IdaReport& r) {
  a(r.termination)(r.iterations)(r.residual_norm)(r.message)(r.time)(r.step)(r.worst_unknowns);
}
}  // namespace snare::numerics

namespace snare::coupling {
void fields(auto& a, ContactSample& s) {
  static_assert(sizeof(ContactSample) == 15 * sizeof(double));
  a(s.closed)(s.gap)(s.force)(s.normal_force)(s.point)(s.arc)(s.slip_speed)(s.sticking)(s.points);
}
void fields(auto& a, EnergyBalance& e) {
  static_assert(sizeof(EnergyBalance) == 7 * sizeof(double));
  a(e.kinetic)(e.strain)(e.potential)(e.dissipated)(e.work)(e.integrator)(e.corrected);
}
void fields(auto& a, MotionSample::Arm& s) {
  a(s.state)(s.work)(s.joint_torque)(s.drive_torque);
}
void fields(auto& a, MotionSample::Bushing& b) {
  a(b.shift)(b.turn)(b.on_second);
}
void fields(auto& a, WireLoads& l) {
  a(l.velocities)(l.tensions)(l.curvatures);
}
void fields(auto& a, MotionSample& s) {
  static_assert(sizeof(MotionSample) ==
                sizeof(double) + 9 * sizeof(std::vector<double>) + 13 * sizeof(double));
  a(s.time)(s.bodies)(s.contacts)(s.wires)(s.mount_forces)(s.wire_loads)(s.law_tensions)(s.arms)(s.welds)(
      s.bushings)(s.energy)(s.momentum)(s.angular_momentum);
}
void fields(auto& a, MotionEvent& e) {
  static_assert(sizeof(MotionEvent) == 5 * sizeof(double));
  a(e.time)(e.contact)(e.point)(e.arc)(e.kind)(e.approach_speed);
}
void fields(auto& a, StrengthUse& u) {
  static_assert(sizeof(StrengthUse) == 5 * sizeof(double));
  a(u.share)(u.tension)(u.bending)(u.arc)(u.time);
}
void fields(auto& a, WireUse& u) {
  static_assert(sizeof(WireUse) == 6 * sizeof(double));
  a(u.peak_tension)(u.peak_time)(u.tight_since)(u.tight_at)(u.last_tension)(u.last_time);
}
void fields(auto& a, PhaseBeginning& p) {
  a(p.phase)(p.time)(p.angles);
}
void fields(auto& a, LeftOutInertia& i) {
  static_assert(sizeof(LeftOutInertia) == 2 * sizeof(double));
  a(i.kinetic)(i.force);
}
void fields(auto& a, MotionSums& s) {
  a(s.events)(s.peak_force)(s.strength)(s.left_out)(s.wires)(s.phases)(s.largest_penetration)(
      s.largest_drift)(s.start_energy)(s.start_momentum)(s.start_angular_momentum)(s.samples)(s.statistics)(
      s.wall_seconds)(s.effort);
}
void fields(auto& a, MotionState& s) {
  a(s.time)(s.unknowns)(s.rates)(s.integrals)(s.memory)(s.sums);
}
void fields(auto& a, MotionResult& r) {
  a(r.report)(r.events)(r.energy)(r.momentum_error)(r.angular_momentum_error)(r.peak_force)(r.strength)(
      r.left_out)(r.wires)(r.phases)(r.impulse)(r.largest_penetration)(r.largest_drift)(r.statistics)(
      r.wall_seconds)(r.last);
}
}  // namespace snare::coupling

namespace snare::results {
void fields(auto& a, MotionRecord& m) {
  a(m.samples)(m.result);
}
}  // namespace snare::results

namespace snare::app {

void fields(auto& a, MotionProgress& p) {
  bool begun = p.state.has_value();
  a(p.finished)(p.samples)(begun);
  if (!begun) return;
  if (!p.state) p.state.emplace();
  a(*p.state);
}

namespace {

constexpr std::string_view mark = "snare motion checkpoint 5\n";

/// Of the input and of the program that is to go on with it.
std::uint64_t key_of(const std::string& input) {
  return base::fingerprint(version() + '\n' + input);
}

}  // namespace

// The mark, the key, the fingerprint of the content, the content.
void write_motion_checkpoint(const std::filesystem::path& file, const std::string& input,
                             MotionProgress& progress) {
  base::ByteWriter content;
  content(progress);
  base::ByteWriter head;
  std::uint64_t key = key_of(input);
  std::uint64_t sum = base::fingerprint(content.bytes());
  head(key)(sum);
  base::AtomicFile out(file);
  out.write(mark);
  out.write(head.bytes());
  out.write(content.bytes());
  out.commit();
}

LoadedCheckpoint read_motion_checkpoint(const std::filesystem::path& file, const std::string& input) {
  std::error_code code;
  if (!std::filesystem::exists(file, code)) return {};
  const auto refused = [&file](const std::string& why) {
    return LoadedCheckpoint{std::nullopt, fmt::format("{}: {}; begins anew", file.string(), why)};
  };
  try {
    const std::string text = base::read_own(file, std::numeric_limits<std::size_t>::max());
    std::string_view rest = text;
    if (rest.substr(0, mark.size()) != mark) return refused("is no checkpoint of this program");
    rest.remove_prefix(mark.size());
    std::uint64_t key = 0;
    std::uint64_t sum = 0;
    base::ByteReader head(rest);
    head(key)(sum);
    rest.remove_prefix(sizeof key + sizeof sum);
    if (key != key_of(input)) return refused("the checkpoint is of other input or of another version");
    if (sum != base::fingerprint(rest)) return refused("the checkpoint is damaged");
    LoadedCheckpoint loaded;
    loaded.progress.emplace();
    base::ByteReader content(rest);
    content(*loaded.progress);
    return loaded;
  } catch (const std::exception& error) {
    return refused(error.what());
  }
}

}  // namespace snare::app
