#include "validation/frequency_checks.hpp"

#include "base/index.hpp"
#include "coupling/dynamics/model/modes.hpp"
#include "numerics/dense_solvers.hpp"
#include "validation/scenario_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <string>

namespace snare::validation {

namespace {

using base::at;
using coupling::MotionSample;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double two_pi = 2.0 * std::numbers::pi;

Row frequency_row(const std::string& name, const std::string& unit, const std::string& source, Kind kind,
                  double reference, double value, const Limit& limit) {
  return {"capture", name, unit, source, kind, reference, value, limit};
}

/// Exponents [1/s] of the sum of decaying oscillations that signals (channels x samples), `interval` [s]
/// apart, consist of: the shift between two halves of what is in them (Juang and Pappa 1985, the eigensystem
/// realization). keep: of the largest singular value, what still counts.
Eigen::VectorXcd exponents(const MatrixXd& signals, double interval, double keep) {
  const Index channels = signals.rows(), depth = signals.cols() / 2, width = signals.cols() - depth;
  MatrixXd now(channels * depth, width - 1), later(channels * depth, width - 1);
  for (Index i = 0; i < depth; ++i) {
    now.middleRows(channels * i, channels) = signals.middleCols(i, width - 1);
    later.middleRows(channels * i, channels) = signals.middleCols(i + 1, width - 1);
  }
  const numerics::ThinSvd svd = numerics::thin_svd(now);
  const VectorXd& s = svd.s;
  Index rank = 0;
  while (rank < s.size() && s[rank] > keep * s[0]) ++rank;
  const MatrixXd U = svd.U.leftCols(rank), V = svd.V.leftCols(rank);
  const MatrixXd step = U.transpose() * later * V * s.head(rank).cwiseInverse().asDiagonal();
  return numerics::general_eigen(step).values.array().log() / interval;
}

/// What is watched, and how.
struct Watch {
  double pulse = 0.0;                        ///< duration of the disturbance [s]
  double from = 0.0, to = 0.0, every = 0.0;  ///< behind its beginning [s]
  double keep = 1e-7;                        ///< see `exponents`
  std::function<VectorXd(const MotionSample&)> see;
};

/// What a pulse makes of a motion from a state on, every column a time: half the difference of a pulse and
/// its opposite, without the terms that go with the square of the pulse. With them the swing of one period a
/// record, damped by 8.5e-4, appears damped by 3.3e-3.
MatrixXd answer(const scenario::NamedMotion& asked, const coupling::MotionState& state,
                coupling::FrameLoad load, const Watch& watch) {
  coupling::MotionOptions options = asked.options;
  options.output_interval = watch.every;
  options.duration = state.time + watch.to;
  options.relative_tolerance = 1e-7;
  options.body_position_tolerance = options.angle_tolerance = 1e-10;
  options.body_velocity_tolerance = options.spin_tolerance = 1e-8;
  options.newton_share = 1e-3;
  options.max_order = 5;
  coupling::MotionState from = state;
  from.sums.samples = std::lround(state.time / watch.every);  // outputs so far, by the new interval
  load.times = {state.time, state.time + 0.5 * watch.pulse, state.time + watch.pulse};
  const Eigen::Vector3d force = load.forces.col(0), moment = load.moments.col(0);
  const auto run = [&](double sign) {
    load.forces = Eigen::Matrix3Xd::Zero(3, 3);
    load.moments = Eigen::Matrix3Xd::Zero(3, 3);
    load.forces.col(1) = sign * force;
    load.moments.col(1) = sign * moment;
    coupling::Motion motion = asked.motion;
    motion.loads.push_back(load);
    std::vector<VectorXd> seen;
    const coupling::MotionResult result = coupling::simulate(
        motion, options,
        [&](const MotionSample& s) {
          if (s.time > state.time + watch.from) seen.push_back(watch.see(s));
          return false;
        },
        &from);
    return result.report.usable() ? seen : std::vector<VectorXd>{};
  };
  const std::vector<VectorXd> there = run(1.0), back = run(-1.0);
  const std::size_t count = std::min(there.size(), back.size());
  if (count == 0) return {};
  MatrixXd difference(there[0].size(), static_cast<Index>(count));
  for (std::size_t k = 0; k < count; ++k) difference.col(static_cast<Index>(k)) = 0.5 * (there[k] - back[k]);
  return difference;
}

/// Largest relative errors of a mode.
struct Agreement {
  double frequency, damping;
};
// A held visitor swings linearly: the parts of the third order in the pulse and the integrator's errors stay.
constexpr Agreement linear{1e-4, 1e-3};
// In strings the state drifts while it is watched, and the answer depends on the size of the pulse: 2 and 2.5
// percent of the damping at a third of the pulse and at the whole.
constexpr Agreement drifting{0.01, 0.05};

/// A row for each of these frequencies [Hz] by eigenvalues: that of the answer which is nearest.
void compare(const std::string& what, const std::vector<coupling::MotionMode>& modes, double lowest,
             double highest, const MatrixXd& signals, const Watch& watch, const Agreement& agreement,
             std::vector<Row>& rows) {
  Eigen::VectorXcd found;
  if (signals.size() > 0) found = exponents(signals, watch.every, watch.keep);
  for (const coupling::MotionMode& m : modes) {
    if (m.frequency < lowest || m.frequency > highest) continue;
    const double size = two_pi * m.frequency;
    const std::complex<double> expected(-m.damping * size, size * std::sqrt(1.0 - m.damping * m.damping));
    std::complex<double> nearest(not_computed, not_computed);
    for (const std::complex<double>& lambda : found)
      if (!(std::abs(nearest - expected) <= std::abs(lambda - expected))) nearest = lambda;
    const std::string name =
        fmt::format("{}, {} swings: ", what, m.shares.empty() ? "all" : m.shares[0].first);
    rows.push_back(frequency_row(name + "frequency", "Hz", "a small disturbance, simulated",
                                 Kind::convergence, std::abs(nearest) / two_pi, m.frequency,
                                 Limit::relative(agreement.frequency)));
    rows.push_back(frequency_row(name + "damping ratio", "", "a small disturbance, simulated",
                                 Kind::convergence, -nearest.real() / std::abs(nearest), m.damping,
                                 Limit::relative(agreement.damping)));
  }
}

coupling::FrameLoad push_on(const coupling::MotionCarrier& carrier, const multibody::Pose& X_WF,
                            const Eigen::Vector3d& force, const Eigen::Vector3d& moment) {
  coupling::FrameLoad load;
  load.name = "disturbance";
  load.carrier = carrier;
  load.X_WF = X_WF;
  load.in_frame = false;
  load.forces = force;
  load.moments = moment;
  return load;
}

int body_called(const coupling::Motion& motion, const std::string& name) {
  const auto found = std::ranges::find(motion.bodies, name, &coupling::MotionBody::name);
  return static_cast<int>(found - motion.bodies.begin());
}

coupling::FrameLoad push_on_body(const coupling::Motion& motion, const std::string& name,
                                 const Eigen::Vector3d& force, const Eigen::Vector3d& moment) {
  const int index = body_called(motion, name);
  return push_on({coupling::MotionCarrier::Kind::body, index, 0},
                 scenario::pose_of(motion.bodies[at(index)].start), force, moment);
}

}  // namespace

std::vector<Row> held_frequency_rows(const std::filesystem::path& data) {
  const ScenarioRun run = run_of(data / "scenarios/ssrms_htv_held.toml",
                                 {"duration_s=1.0", "loads[thruster].moment_Nm=[0.0,0.0,0.0]"});
  const std::vector<coupling::MotionMode> modes =
      coupling::small_motions_at(run.asked.motion, run.asked.options, run.result.last).modes;
  Watch watch{0.1, 0.5,  20.5,
              0.1, 1e-5, [](const MotionSample& s) -> VectorXd { return s.arms[0].state.q.tail<7>(); }};
  const MatrixXd signals =
      answer(run.asked, run.result.last,
             push_on_body(run.asked.motion, "htv", {200.0, 150.0, 100.0}, {5000.0, 3000.0, -4000.0}), watch);
  std::vector<Row> rows;
  compare("visitor of 16 t held on the arm", modes, 0.01, 1.0, signals, watch, linear, rows);
  if (!run.result.report.usable() || rows.empty())
    rows.push_back(frequency_row("visitor of 16 t held on the arm, modes below 1 Hz", "",
                                 "six freedoms of the visitor", Kind::closed_form, 6.0, not_computed,
                                 Limit::relative(0.1)));
  return rows;
}

// Eight seconds into the shipped capture: tight, the arm limp.
std::vector<Row> capture_frequency_rows(const std::filesystem::path& data) {
  const ScenarioRun run = run_of(data / "scenarios/ssrms_htv_capture.toml",
                                 {as_strings, "duration_s=8.0", "output_interval_s=0.05"});
  const std::vector<coupling::MotionMode> modes =
      coupling::small_motions_at(run.asked.motion, run.asked.options, run.result.last).modes;
  std::vector<Row> rows;
  const auto angles = [](const MotionSample& s) -> VectorXd { return s.arms[0].state.q.tail<8>(); };
  const Watch slow{0.05, 0.3, 2.7, 0.02, 1e-5, angles};
  compare("visitor of 16 t in strings", modes, 2.5, 4.0,
          answer(run.asked, run.result.last,
                 push_on_body(run.asked.motion, "htv", {50.0, 50.0, 50.0}, {500.0, 300.0, -400.0}), slow),
          slow, drifting, rows);
  const coupling::MotionArm& arm = run.asked.motion.arms[0];
  const coupling::MotionCarrier ring{coupling::MotionCarrier::Kind::arm, 0,
                                     arm.arm.tree.find_frame("snare::turning")};
  const Watch fast{5e-4, 1e-3, 1.1e-2, 1e-4, 1e-5, [](const MotionSample& s) -> VectorXd {
                     const multibody::ArmState& a = s.arms[0].state;
                     return (VectorXd(2) << a.q[a.q.size() - 1], a.v[a.v.size() - 1]).finished();
                   }};
  compare("visitor of 16 t in strings", modes, 200.0, 600.0,
          answer(run.asked, run.result.last, push_on(ring, {}, {0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}), fast), fast,
          drifting, rows);
  return rows;
}

// Where nothing else gives, the bushing alone sets the roll, (K/I)^1/2; on joints like the real ones' hardly.
std::vector<Row> bushing_frequency_rows(const std::filesystem::path& data) {
  constexpr double K = 1.0e8, I = 38700.0;
  const auto roll = [&](double joints, double bushing) {
    const ScenarioRun run =
        run_of(data / "scenarios/ssrms_htv_held.toml",
               {"duration_s=0.02", fmt::format("arms[rms].every_joint.stiffness_Nm_rad={}", joints),
                "arms[rms].every_joint.damping_Nms_rad=0.0", "bushings[gf].rotational_damping_Nms_rad=0.0",
                fmt::format("bushings[gf].rotational_stiffness_Nm_rad={}", bushing)});
    double frequency = not_computed, most = 0.0;
    for (const coupling::MotionMode& m :
         coupling::small_motions_at(run.asked.motion, run.asked.options, run.result.last).modes) {
      for (const auto& [name, share] : m.shares) {
        if (name != "htv turn x" || share <= most) continue;
        most = share;
        frequency = m.frequency;
      }
    }
    return frequency;
  };
  const auto sensitivity = [&](double joints) {
    return std::log(roll(joints, 1.05 * K) / roll(joints, K / 1.05)) / (2.0 * std::log(1.05));
  };
  const std::string name = "roll of a held visitor of 16 t, joints of ";
  return {frequency_row(name + "1e12 N m/rad", "Hz", "(K_GF/I)^1/2/(2 pi)", Kind::closed_form,
                        std::sqrt(K / I) / two_pi, roll(1e12, K), Limit::relative(1e-3)),
          frequency_row(name + "1e12 N m/rad: d ln f/d ln K_GF", "", "the bushing alone", Kind::closed_form,
                        0.5, sensitivity(1e12), Limit::relative(2e-3)),
          frequency_row(
              name + "1e6 N m/rad: d ln f/d ln K_GF", "", "K_GF stiff beside the joints", Kind::closed_form,
              0.0, sensitivity(1e6),
              Limit::absolute(0.01, "zero reference; the exponent is 1/2 where the bushing gives alone"))};
}

std::vector<Check> frequency_checks(const std::filesystem::path& data) {
  return {{"frequencies of a held visitor", [data] { return held_frequency_rows(data); }},
          {"frequencies in the capture of 16 t", [data] { return capture_frequency_rows(data); }},
          {"roll on a bushing", [data] { return bushing_frequency_rows(data); }}};
}

}  // namespace snare::validation
