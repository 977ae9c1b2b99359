#include "base/units.hpp"
#include "papers/abiko_bench.hpp"
#include "papers/papers.hpp"
#include "results/motion_record.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace snare::papers {

namespace {

using validation::Kind;
using validation::Limit;

constexpr auto measurement = Kind::published_measurement;
constexpr auto computation = Kind::published_computation;
using base::degree;

// ---- joints in orbit: Table 2, Fig. 6 ----

Case joint_step(Runs&) {
  return {"scenarios/jemrms_step.toml", {}};
}

FigureResult table_2(Runs& runs) {
  const Run& run = runs.of(joint_step(runs));
  const multibody::DeflectionLaw& law =
      run.asked.motions.runs.front().motion.arms.front().arm.joints.front().spring;
  const double per_degree = degree;  // N m/rad of 1 N m/deg is 1/degree; of a stiffness in N m/rad a degree
  const auto stiffness = [&](double deg) { return per_degree * law.stiffness(law.branch_of(deg * degree)); };
  const auto damping = [&](double deg) {
    return per_degree * law.damping(law.branch_of(deg * degree), deg * degree);
  };
  FigureResult result =
      inputs({{"stiffness below 0.04 deg", "N m/deg", 12.5, stiffness(0.02), 0.1},
              {"stiffness between 0.04 and 0.06 deg", "N m/deg", 475.0, stiffness(0.05), 1.0},
              {"stiffness above 0.06 deg", "N m/deg", 475.0, stiffness(0.1), 1.0},
              {"viscosity below 0.04 deg", "N m s/deg", 48.9, damping(0.02), 0.1},
              {"viscosity between 0.04 and 0.06 deg", "N m s/deg", 87.3, damping(0.05), 0.1},
              {"viscosity above 0.06 deg", "N m s/deg", 17.6, damping(0.1), 0.1}},
             computation);
  result.findings.emplace_back(
      "Read as torque over deflection the table would let the torque jump at 0.04 deg from 0.5 to 19 N m; it "
      "is read "
      "as the slope, which "
      "keeps the torque continuous.");
  return result;
}

FigureResult figure_6(Runs& runs) {
  const Run& run = runs.of(joint_step(runs));
  FigureResult result;
  const auto swings =
      results::swings_of(run.asked.motions, {run.asked.motions.runs.front(), run.samples, run.result});
  if (swings.size() < 2) return result;
  const auto [slow, fast] =
      std::ranges::minmax_element(swings, {}, [](const scenario::Swing& s) { return s.frequency(); });
  result.findings.push_back(
      fmt::format("{} swings; their frequency goes from {} Hz at a peak of {} deg to {} Hz at {} deg.",
                  swings.size(), digits(fast->frequency(), 3), digits(std::abs(fast->peak) / degree, 2),
                  digits(slow->frequency(), 3), digits(std::abs(slow->peak) / degree, 2)));
  result.rows.push_back(statement(
      "the larger of the extreme swings is the faster one: frequency varies with amplitude", measurement,
      std::abs(fast->peak) > std::abs(slow->peak) && fast->frequency() > 1.1 * slow->frequency()));
  return result;
}

// ---- the air table: Table 5, Figs. 13 to 16 ----

/// Keys that give the wire of a scenario and its mounts the numbers of the traced ones.
std::vector<std::string> traced_keys(const Runs& runs) {
  const coupling::PushProblem test = traced_wire(runs).test;
  std::string gives;
  if (test.mount.translational_stiffness)
    gives += fmt::format(",translational_stiffness_N_m={:.17g}", *test.mount.translational_stiffness);
  if (test.mount.rotational_stiffness)
    gives += fmt::format(",rotational_stiffness_Nm_rad={:.17g}", *test.mount.rotational_stiffness);
  return {fmt::format("wires[wire].bending_stiffness_Nm2={:.17g}", test.wire.bending_stiffness()),
          fmt::format("wires[wire].axial_stiffness_N={:.17g}", test.wire.axial_stiffness()),
          fmt::format("wires[wire].length_mm={:.17g}", 1e3 * test.wire.length),
          fmt::format("wires[wire].mount={{kind=\"clamped\"{}}}", gives)};
}

double touch(const Run& run) {
  return run.first_touch(0);
}

Case air_table_law(Runs&) {
  return {"scenarios/air_table.toml", {"wires[wire].model=\"quadratic\""}};
}
Case air_table_declared(Runs&) {
  return {"scenarios/air_table.toml"};
}
/// Between mounts that give the wire stands out further, so that the body starts further away.
Case air_table_traced(Runs& runs) {
  std::vector<std::string> settings = traced_keys(runs);
  settings.insert(settings.end(), {"bodies[target].position_mm=[40.0,-97.0,0.0]", "duration_s=0.6"});
  return {"scenarios/air_table.toml", settings};
}

FigureResult table_5(Runs& runs) {
  const Run& run = runs.of(air_table_declared(runs));
  const multibody::RigidBodyProperties& target =
      run.asked.motions.runs.front().motion.bodies.front().properties;
  const Eigen::Matrix3Xd& wire = run.samples.front().wires.front();
  const Eigen::Index edges = wire.cols() - 1;
  const double length = (wire.rightCols(edges) - wire.leftCols(edges)).colwise().norm().sum();
  return inputs({{"length of the wire", "mm", 180.0, 1e3 * length, 1.0},
                 {"fixed length of the wire", "mm", 175.0, 1e3 * (wire.col(edges) - wire.col(0)).norm(), 1.0},
                 {"mass of the target", "kg", 8.9, target.mass, 0.1},
                 {"inertia of the target", "kg m^2", 0.16, target.inertia(2, 2), 0.01}},
                measurement);
}

FigureResult figure_13(Runs& runs) {
  FigureResult result;
  result.scene = &runs.of(air_table_traced(runs));
  return result;
}

double final_of(const Run& run, const std::string& column) {
  return run.columns("time_s", column).second.back();
}

FigureResult figure_14(Runs& runs) {
  FigureResult result;
  for (const auto& [name, asked] :
       {NamedCase{"quadratic law", air_table_law}, NamedCase{"traced wire", air_table_traced}}) {
    const Run& run = runs.of(asked(runs));
    const double before = run.samples.front().bodies.front().velocity.norm(),
                 after = run.samples.back().bodies.front().velocity.norm();
    result.rows.push_back(statement(fmt::format("{}: the target is slower behind the contact", name),
                                    measurement, after + run.usable() < before));
    result.findings.push_back(fmt::format("{}: {} m/s before the contact, {} m/s behind it.", name,
                                          digits(before, 3), digits(after, 3)));
  }
  return result;
}

FigureResult figure_15(Runs& runs) {
  FigureResult result;
  for (const auto& [name, asked] :
       {NamedCase{"quadratic law", air_table_law}, NamedCase{"traced wire", air_table_traced}}) {
    const Run& run = runs.of(asked(runs));
    const double rate = final_of(run, "target wz_rad_s");
    result.rows.push_back(statement(fmt::format("{}: the target starts rotating", name), measurement,
                                    std::abs(rate) + run.usable() > 0.01));
    result.findings.push_back(
        fmt::format("{}: {} deg/s behind the contact.", name, digits(rate / degree, 3)));
  }
  return result;
}

FigureResult figure_16(Runs& runs) {
  const Run &law = runs.of(air_table_law(runs)), &traced = runs.of(air_table_traced(runs)),
            &declared = runs.of(air_table_declared(runs));
  FigureResult result;
  const auto impulse = [](const Run& run) { return run.result.impulse.front().y() + run.usable(); };
  for (const auto& [name, run] : {std::pair{"quadratic law", &law}, std::pair{"traced wire", &traced},
                                  std::pair{"declared wire", &declared}}) {
    result.findings.push_back(fmt::format("{}: peak {} N, impulse along the approach {} N s.", name,
                                          digits(run->result.peak_force.front(), 3),
                                          digits(impulse(*run), 3)));
  }
  result.rows.push_back({"", "impulse of the quadratic law over that of the traced wire: almost the same", "",
                         "Abiko et al., section 4.3", measurement, 1.0, impulse(law) / impulse(traced),
                         Limit::relative(0.1)});
  return result;
}

// ---- the arm: Tables 6 and 7, Figs. 17 to 21 ----

Case payload_law(Runs&) {
  return {
      "scenarios/jemrms_capture.toml",
      {"duration_s=10.0", "wires[wire].quadratic={position_mm=90.0,A_N_m2=890183.0,B_N_m=-1297.6,C_N=0.3457}",
       "wires[wire].model=\"quadratic\""}};
}
Case payload_traced(Runs& runs) {
  std::vector<std::string> settings = traced_keys(runs);
  settings.insert(settings.end(), {"duration_s=11.0", "bodies[payload].position_mm=[-10.0,-497.0,0.0]"});
  return {"scenarios/jemrms_capture.toml", settings};
}

FigureResult table_6(Runs& runs) {
  const multibody::RigidBodyProperties& payload =
      runs.of(payload_law(runs)).asked.motions.runs.front().motion.bodies.front().properties;
  return inputs({{"mass of the payload", "kg", 500.0, payload.mass, 1.0},
                 {"inertia about x", "kg m^2", 415.0, payload.inertia(0, 0), 1.0},
                 {"inertia about y", "kg m^2", 83.0, payload.inertia(1, 1), 1.0},
                 {"inertia about z", "kg m^2", 415.0, payload.inertia(2, 2), 1.0}},
                computation);
}

FigureResult figure_18(Runs& runs) {
  FigureResult result;
  const Run& run = runs.of(payload_law(runs));
  result.scene = &runs.of(payload_traced(runs));
  const double gap = final_of(run, "probe on wire gap_mm"), speed = final_of(run, "payload vy_m_s");
  result.findings.push_back(
      fmt::format("By the quadratic law the payload leaves at {} mm/s; {:g} s after the start its probe is "
                  "{} mm from the wire.",
                  digits(-1e3 * speed, 3), run.samples.back().time, digits(gap, 3)));
  result.rows.push_back(statement("the payload bounces away: its probe has left the wire and moves back",
                                  computation, gap > 0.0 && speed + run.usable() < 0.0));
  return result;
}

/// Angles of the joints beyond those at the start [deg].
FigureResult figure_20(Runs& runs) {
  FigureResult result;
  const Run& run = runs.of(payload_law(runs));
  const double zero = touch(run);
  const multibody::ElasticArm& arm = run.asked.motions.runs.front().motion.arms.front().arm;
  double largest = 0.0;
  for (int j = 0; j < arm.motors(); ++j) {
    const int coordinate = arm.tree.body(arm.joints[static_cast<std::size_t>(j)].body).q_index;
    FigureCurve curve{arm.joints[static_cast<std::size_t>(j)].name};
    for (const coupling::MotionSample& s : run.samples) {
      curve.x.push_back(s.time - zero);
      curve.y.push_back(
          (s.arms.front().state.q[coordinate] - run.samples.front().arms.front().state.q[coordinate]) /
          degree);
      largest = std::max(largest, std::abs(curve.y.back()));
    }
    result.curves.push_back(std::move(curve));
  }
  result.findings.push_back(
      fmt::format("The largest change of a joint angle is {} deg.", digits(largest, 3)));
  result.rows.push_back(
      statement("the arm moves after the contact", computation, largest + run.usable() > 1e-3));
  return result;
}

FigureResult figure_21(Runs& runs) {
  FigureResult result;
  for (const auto& [name, asked] :
       {NamedCase{"quadratic law", payload_law}, NamedCase{"traced wire", payload_traced}}) {
    const Run& run = runs.of(asked(runs));
    FigureCurve attitude{name};
    attitude.panel = 1;
    for (const coupling::MotionSample& s : run.samples) {
      const Eigen::AngleAxisd turn(s.bodies.front().orientation);
      attitude.x.push_back(s.time - touch(run));
      attitude.y.push_back(turn.angle() * turn.axis().z() / degree);
    }
    result.findings.push_back(fmt::format("{}: peak {} N; the payload turns by {} deg in {:g} s.", name,
                                          digits(run.result.peak_force.front(), 3),
                                          digits(attitude.y.back(), 3), attitude.x.back()));
    result.rows.push_back(statement(fmt::format("{}: the payload rotates after the contact", name),
                                    computation, std::abs(attitude.y.back()) + run.usable() > 0.1));
    result.curves.push_back(std::move(attitude));
  }
  return result;
}

constexpr const char* on_the_table =
    "scenario `data/scenarios/air_table.toml`: by the printed quadratic law, by the wire and mounts that "
    "explain Table 4 best, and by the wire as declared. Assumed: approach at 0.1 m/s, probe 50 mm off the "
    "centre of mass. Time is counted from the "
    "first "
    "touch.";
constexpr const char* on_the_arm =
    "scenario `data/scenarios/jemrms_capture.toml`: an arm with the joints of Table 2 and one wire in its "
    "end "
    "effector; by the printed quadratic law at "
    "90 mm and by the traced wire and mounts. Assumed: 10 mm/s for the printed 10 m/s, links, pose, servos, "
    "the place "
    "of the "
    "probe.";

const Axis time{"time from first touch", "s"}, displacement{"displacement", "mm"};

std::vector<Figure> bench_figures() {
  return {
      {"Table 2",
       "Determined characteristics of the joints",
       "The stiffness and the viscosity of a joint depend on its deflection; they were matched to a step "
       "in orbit.",
       "Read back from the arm file `data/arms/jemrms_like.toml`.",
       {},
       {},
       table_2},
      {"Fig. 6",
       "Step of a joint, simulated",
       "The joint is nonlinear, and the frequency of its oscillation varies. The first two vibrations "
       "were matched.",
       "scenario `data/scenarios/jemrms_step.toml`. Assumed: a step of 0.5 deg, the arm and its pose.",
       {{"Deflection of the joint", {"time", "s"}, {"deflection", "deg"}}},
       {{"joint 3", joint_step, "rms::joint_3 deflection_deg"}},
       figure_6},
      {"Table 3",
       "Conditions of the wire",
       "SUS-304, fixed at both ends with slack.",
       "Read back from `data/experiments/published_static.toml`.",
       {},
       {},
       conditions_of_the_wire},
      {"Fig. 9",
       "The loose wire and the largest displacement Q",
       "The displacement is counted from the initial position and ends at Q, which follows from total "
       "and fixed "
       "length.",
       "Shape of the declared wire at rest; Q by the ellipse about the mounts.",
       {{"Loose and taut wire", {"along the chord", "mm"}, {"off the chord", "mm"}, true}},
       {},
       largest_displacement},
      {"Fig. 10",
       "Force and displacement at three positions",
       "The force grows faster than the displacement; the offset at zero is measurement error; at 40 and "
       "65 mm the "
       "ends slipped.",
       "The printed fits with the scatter that their R2 implies; the declared wire; the wire and mounts "
       "that explain the fits best, with their zeros and over their range, which the paper does not give.",
       {{"Reaction force", displacement, {"force", "N"}}},
       {},
       forces_at_three_positions},
      {"Table 4",
       "Quadratic fits F = A d^2 + B d + C",
       "F in N, d in m; A, B, C and R2 at three positions.",
       "The same fit through the curve of the traced wire.",
       {},
       {},
       quadratic_fits},
      {"Fig. 11",
       "Stiffness of the linear spring-dashpot model",
       "The stiffness becomes larger as the displacement becomes larger.",
       "Secant F/d and tangent dF/dd of the printed fits and of the traced wire; which of them the paper "
       "draws is not "
       "in the text.",
       {{"Secant stiffness", displacement, {"F/d", "N/mm"}},
        {"Tangent stiffness", displacement, {"dF/dd", "N/mm"}}},
       {},
       stiffness_at_three_positions}};
}

/// A column of history.csv by every model of the wire on the air table.
std::vector<HistoryCurve> on_the_table_by_model(const char* column, double factor) {
  return {{"quadratic law", air_table_law, column, 0, factor, "time_s", touch},
          {"traced wire", air_table_traced, column, 0, factor, "time_s", touch},
          {"declared wire", air_table_declared, column, 0, factor, "time_s", touch}};
}

std::vector<Figure> air_table_figures() {
  return {{"Table 5",
           "Conditions of the dynamic experiment",
           "Wire as in Table 3, pushed 90 mm from its lower end; target of 8.9 kg and 0.16 kg m^2.",
           "Read back from `data/scenarios/air_table.toml`.",
           {},
           {},
           table_5},
          {"Fig. 13",
           "Simulation model of the contact experiment",
           "An air-floating target with a probe moves towards an upright wire.",
           on_the_table,
           {},
           {},
           figure_13},
          {"Fig. 14",
           "Velocity of the target",
           "The target slows down and ends at a constant velocity; it oscillates during the contact.",
           on_the_table,
           {{"Velocity of the centre of mass along the approach", time, {"velocity", "m/s"}}},
           on_the_table_by_model("target vy_m_s", 1.0),
           figure_14},
          {"Fig. 15",
           "Angular velocity of the target",
           "The target starts rotating with the contact.",
           on_the_table,
           {{"Angular velocity", time, {"angular velocity", "deg/s"}}},
           on_the_table_by_model("target wz_rad_s", 1.0 / degree),
           figure_15},
          {"Fig. 16",
           "Reaction force on the air table",
           "Measured and simulated peaks differ, their impulses are almost the same.",
           on_the_table,
           {{"Reaction force", time, {"force", "N"}}},
           on_the_table_by_model("probe on wire normal_N", 1.0),
           figure_16}};
}

std::vector<Figure> arm_figures() {
  return {{"Tables 6 and 7",
           "Dynamic properties of the payload",
           "Both tables print the same numbers.",
           "Read back from `data/scenarios/jemrms_capture.toml`.",
           {},
           {},
           table_6},
          {"Figs. 17 to 19",
           "Overview and snapshots of the capture",
           "The payload meets the wire, bounces off the capture zone and rotates; the arm vibrates.",
           on_the_arm,
           {},
           {},
           figure_18},
          {"Fig. 20",
           "Joint angles of the JEMRMS",
           "The arm vibrates after the contact.",
           on_the_arm,
           {{"Change of the joint angles, quadratic law", time, {"angle", "deg"}}},
           {},
           figure_20},
          {"Fig. 21",
           "Reaction force and attitude of the payload",
           "The payload rotates after the contact.",
           on_the_arm,
           {{"Reaction force", time, {"force", "N"}}, {"Attitude about z", time, {"angle", "deg"}}},
           {{"quadratic law", payload_law, "probe on wire normal_N", 0, 1.0, "time_s", touch},
            {"traced wire", payload_traced, "probe on wire normal_N", 0, 1.0, "time_s", touch}},
           figure_21}};
}

std::vector<Lost> lost() {
  return {
      {"Figs. 1 to 4, 7, 8, 12", "photographs and sketches; nothing is computed for them"},
      {"Fig. 5, the step in orbit",
       "the readings are not printed; the first two vibrations of Fig. 6 cannot be compared with them"},
      {"readings of Fig. 10", "only their quadratic fits are printed, without range and number of readings"},
      {"curves of Fig. 11", "drawn only; secant or tangent stiffness is not stated. Both are computed"},
      {"c of eqs (3) to (5), G(d), mu", "no values are printed"},
      {"measured curves of Figs. 14 to 16",
       "drawn only; the approach velocity and the place of the probe on the target are not printed: assumed"},
      {"values of Figs. 20 and 21", "drawn only; link data and pose of the arm are not printed: assumed"},
      {"approach of the payload", "printed as 10 m/s, at which no wire would hold: 10 mm/s assumed"},
      {"B at s = 40 mm in Table 4",
       "a hundredth of the others, possibly a slip of the decimal point; taken as printed"},
      {"wire inside the end effector",
       "different from the one on the bench, by the paper's word; its numbers are not printed"}};
}

}  // namespace

const Paper& abiko() {
  static const Paper paper{
      "abiko",
      "Abiko, Uyama, Ikuta, Nagaoka, Yoshida, Nakanishi, Oda: Contact dynamics simulation for capture "
      "operation by snare wire type of end effector",
      "Abiko et al.", joined({bench_figures(), air_table_figures(), arm_figures()}), lost()};
  return paper;
}

}  // namespace snare::papers
