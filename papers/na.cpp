#include "base/units.hpp"
#include "papers/papers.hpp"
#include "reduction/snare_joint.hpp"
#include "validation/distil_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace snare::papers {

namespace {

using base::degree;
using validation::Kind;
using validation::Limit;

constexpr auto computation = Kind::published_computation;

// ---- contact without rigidizing: Tables 1 and 2, Figs. 10 and 11 ----

/// A condition of contact, Fn = Kc d + Dc d', at each of the eight points of the plate.
struct Condition {
  double stiffness, damping;  ///< [N/m], [N s/m]
};
/// Assumed: Table 1 is lost. Those of data/sweeps/rigidizing.csv.
constexpr std::array<Condition, 4> conditions{
    {{2.0e5, 1.0e2}, {2.0e5, 1.0e4}, {2.0e6, 1.0e2}, {2.0e6, 1.0e4}}};

/// The visitor of `ssrms_rigidize.toml` drifts freely, its plate 5 mm before the end effector, and nothing
/// pulls.
Case contact(const Condition& condition) {
  return {
      "scenarios/ssrms_rigidize.toml",
      {"phases[pull].at_s=1000.0", "duration_s=3.0",
       "bushings[ball joint].translational_stiffness_N_m=[0.0,0.0,0.0]",
       "bushings[ball joint].translational_damping_Ns_m=[0.0,0.0,0.0]",
       "bushings[ball joint].rotational_damping_Nms_rad=0.0", "bodies[visitor].position_mm=[0.0,0.0,1025.0]",
       fmt::format("contacts[plate on face].k_N_m={}", condition.stiffness),
       fmt::format("contacts[plate on face].c_Ns_m={}", condition.damping)}};
}
template <std::size_t k>
Case condition(Runs&) {
  return contact(conditions.at(k));
}

/// A column under the four conditions.
std::vector<HistoryCurve> by_condition(const char* column, std::size_t panel, double factor) {
  return {{"condition 01", condition<0>, column, panel, factor},
          {"condition 02", condition<1>, column, panel, factor},
          {"condition 03", condition<2>, column, panel, factor},
          {"condition 04", condition<3>, column, panel, factor}};
}

FigureResult table_1(Runs&) {
  FigureResult result;
  result.table.columns = {"condition", "Kc [N/m]", "Dc [N s/m]"};
  for (std::size_t k = 0; k < conditions.size(); ++k)
    result.table.rows.push_back(
        {fmt::format("{:02}", k + 1), digits(conditions[k].stiffness), digits(conditions[k].damping)});
  return result;
}

FigureResult table_2(Runs& runs) {
  const Run& run = runs.of(condition<1>(runs));
  const auto first = [&run](const char* column) { return run.columns("time_s", column).second.front(); };
  return inputs({{"initial velocity along x", "m/s", 0.0028, first("residual_x_m_s"), 1e-4},
                 {"initial velocity along y", "m/s", -0.009, first("residual_y_m_s"), 1e-3},
                 {"initial velocity along z", "m/s", -0.025, first("residual_z_m_s"), 1e-3},
                 {"initial yaw rate", "deg/s", 0.0, first("visitor wx_rad_s") / degree, 1e-3},
                 {"initial pitch rate", "deg/s", 0.0, first("visitor wy_rad_s") / degree, 1e-3},
                 {"initial roll rate", "deg/s", 0.025, first("visitor wz_rad_s") / degree, 1e-3}},
                computation);
}

FigureResult figure_10(Runs& runs) {
  FigureResult result;
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const Run& run = runs.of(contact(conditions[k]));
    const std::vector<double>& z = run.columns("time_s", "residual_z_m_s").second;
    result.findings.push_back(fmt::format(
        "Condition {:02}: first touch at {} s, peak {} N, velocity along the axis from {} to {} mm/s.", k + 1,
        digits(run.first_touch(0), 3), digits(run.result.peak_force.front(), 3), digits(1e3 * z.front(), 3),
        digits(1e3 * z.back(), 3)));
  }
  return result;
}

// ---- rigidizing: Fig. 12 ----

Case by_ball_joint(Runs&) {
  return {"scenarios/ssrms_rigidize.toml"};
}
Case by_wires(Runs&) {
  return {"scenarios/ssrms_rigidize_wires.toml"};
}
Case heavy(Runs&) {
  return {"scenarios/ssrms_rigidize.toml",
          {"bodies[visitor].mass_kg=13000.0", "bodies[visitor].inertia_kg_m2=[20000.0,20000.0,10000.0]"}};
}

/// First touch of a contact by its name [s].
double touch_of(const Run& run, const std::string& contact) {
  const std::vector<std::string> names = run.asked.motions.runs.front().motion.contact_names();
  const auto found = std::ranges::find(names, contact);
  if (found == names.end()) throw std::out_of_range("no contact \"" + contact + "\"");
  return run.first_touch(static_cast<std::size_t>(found - names.begin()));
}

FigureResult figure_12(Runs& runs) {
  FigureResult result;
  bool overloaded = false;
  for (const NamedCase& model :
       {NamedCase{"ball joint, 1.3 t", by_ball_joint}, NamedCase{"three wires, 1.3 t", by_wires},
        NamedCase{"ball joint, 13 t", heavy}}) {
    const Run& run = runs.of(model.run(runs));
    const double touch = touch_of(run, "plate on face");
    const auto [times, pull] = run.columns("time_s", "snare::carriage torque_N");
    double before = 0.0, behind = 0.0;
    for (std::size_t i = 0; i < pull.size(); ++i)
      (times[i] < touch ? before : behind) = std::max(times[i] < touch ? before : behind, std::abs(pull[i]));
    overloaded = overloaded || behind > before;
    result.findings.push_back(
        fmt::format("{}: the plate meets the end effector at {} s; largest force of the pull {} N before, {} "
                    "N behind that.",
                    model.name, digits(touch, 3), digits(before, 3), digits(behind, 3)));
    if (model.run == heavy) continue;  // another reading of the text than the printed mass
    result.rows.push_back({"", fmt::format("{}: the plate meets the end effector", model.name), "s", "",
                           computation, 7.0, touch + run.usable(),
                           Limit::absolute(0.5, "printed as about 7 seconds, half of the last digit")});
  }
  if (!overloaded)
    result.findings.emplace_back(
        "The overload of the pull by the strike, which the text reports, is not reproduced.");
  return result;
}

// ---- the constraint test: Figs. 16 to 19 ----

Case constraint_test(Runs&) {
  return {"scenarios/constraint_test.toml"};
}

/// An axis of the test: when it is moved, and the columns of way and force.
struct Leg {
  const char* name;
  double from, to;
  const char *way, *force;
  double amplitude;  ///< [m]
};
constexpr std::array<Leg, 3> legs{{{"x", 0.9, 3.9, "robot::x motor_mm", "sensor fx_N", 3e-3},
                                   {"y", 3.9, 6.9, "robot::y motor_mm", "sensor fy_N", 3e-3},
                                   {"z", 6.9, 9.9, "robot::z motor_mm", "sensor fz_N", 10e-3}}};

std::vector<HistoryCurve> translation(const Leg& leg) {
  std::vector<HistoryCurve> curves;
  for (const char* column : {"sensor fx_N", "sensor fy_N", "sensor fz_N"})
    curves.push_back({column + 7, constraint_test, column, 0});
  for (const char* column : {"sensor mx_Nm", "sensor my_Nm", "sensor mz_Nm"})
    curves.push_back({column + 7, constraint_test, column, 1});
  curves.push_back({"deflection", constraint_test, leg.way, 2});
  for (HistoryCurve& curve : curves) {
    curve.from = leg.from;
    curve.to = leg.to;
  }
  return curves;
}

/// R^2 of the straight line through the points.
double linearity(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mx = 0.0, my = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += x[i] / n;
    my += y[i] / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    xy += (x[i] - mx) * (y[i] - my);
    yy += (y[i] - my) * (y[i] - my);
  }
  return xy * xy / (xx * yy);
}

/// The same test at rest: the shaft in the seat of the closed wires.
const std::vector<reduction::JointCycle>& cycles(Runs& runs) {
  return runs.once<std::vector<reduction::JointCycle>>("shaft in a closed snare", [&runs] {
    std::vector<reduction::JointCycle> all;
    for (int axis = 0; axis < 3; ++axis) {
      runs.go_on();
      all.push_back(reduction::cycle_snare(validation::half_scale_snare(), axis,
                                           legs.at(static_cast<std::size_t>(axis)).amplitude, 120));
      if (!all.back().report.usable()) throw std::runtime_error(all.back().report.message);
    }
    return all;
  });
}

FigureResult figure_19(Runs& runs) {
  FigureResult result;
  const Run& run = runs.of(constraint_test(runs));
  for (std::size_t axis = 0; axis < legs.size(); ++axis) {
    const Leg& leg = legs[axis];
    const auto [times, way] = run.columns("time_s", leg.way);
    const std::vector<double>& force = run.columns("time_s", leg.force).second;
    FigureCurve moved{"closing wires"}, seated{"shaft in its seat"};
    moved.panel = seated.panel = axis;
    for (std::size_t i = 0; i < way.size(); ++i) {
      if (times[i] < leg.from || times[i] > leg.to) continue;
      moved.x.push_back(way[i]);
      moved.y.push_back(force[i]);
    }
    const reduction::JointCycle& cycle = cycles(runs)[axis];
    for (const coupling::ShaftPoint& point : cycle.path) {
      seated.x.push_back(1e3 * point.displacement[static_cast<Eigen::Index>(axis)]);
      seated.y.push_back(point.force[static_cast<Eigen::Index>(axis)]);
    }
    result.findings.push_back(fmt::format(
        "{}: R2 of a straight line is {} in the test with closing wires and {} with the shaft in its seat.",
        leg.name, digits(linearity(moved.x, moved.y), 3), digits(cycle.linear_r2, 3)));
    result.curves.push_back(std::move(moved));
    result.curves.push_back(std::move(seated));
  }
  result.findings.emplace_back(
      "Along y the closing wires are less linear than the text says: with the pretension that the scenario "
      "assumes, "
      "they resist a move "
      "along +y more than one along -y.");
  return result;
}

const Axis time{"time", "s"}, velocity{"velocity", "m/s"}, rate{"rate", "deg/s"}, force{"force", "N"},
    torque{"torque", "N m"}, deflection{"deflection", "mm"};
constexpr const char* contact_method =
    "scenario `data/scenarios/ssrms_rigidize.toml` without ball joint and pull: the visitor of 1.3 t drifts "
    "against "
    "the end effector of the arm from 5 mm. "
    "The four conditions are assumed.";
constexpr const char* test_method =
    "scenario `data/scenarios/constraint_test.toml`: three wires close on the pin, a robot moves it, a "
    "force/torque "
    "sensor reads. Sizes, wires and friction are assumed.";
const auto panels = [](const char* x, const char* y, const char* z, const Axis& axis) {
  return std::vector<Panel>{{x, time, axis}, {y, time, axis}, {z, time, axis}};
};
const std::vector<Panel> readings{
    {"Force on the pin", time, force}, {"Torque on the pin", time, torque}, {"Deflection", time, deflection}};

std::vector<Figure> contact_figures() {
  return {{"Table 1",
           "Conditions of contact",
           "Four pairs of stiffness and damping; condition 02 was adopted.",
           "The values are lost. These are assumed.",
           {},
           {},
           table_1},
          {"Table 2",
           "Initial condition of the relative motion",
           "In the coordinates of the end effector.",
           "Read back from the first sample of the run.",
           {},
           {},
           table_2},
          {"Fig. 10", "Velocity of the spacecraft",
           "Velocities after contact without rigidizing under four conditions of contact.", contact_method,
           panels("Velocity along x", "Velocity along y", "Velocity along z, the axis of the end effector",
                  velocity),
           joined({by_condition("residual_x_m_s", 0, 1.0), by_condition("residual_y_m_s", 1, 1.0),
                   by_condition("residual_z_m_s", 2, 1.0)}),
           figure_10},
          {"Fig. 11", "Angular rate of the spacecraft", "Rates of the same runs.", contact_method,
           panels("Rate about x", "Rate about y", "Rate about z, roll", rate),
           joined({by_condition("visitor wx_rad_s", 0, 1.0 / degree),
                   by_condition("visitor wy_rad_s", 1, 1.0 / degree),
                   by_condition("visitor wz_rad_s", 2, 1.0 / degree)})},
          {"Fig. 12",
           "Rigidizing",
           "The pin is pulled for 2 s from 5 s on. The spacecraft strikes the inner surface about 7 s from "
           "the start, and "
           "the collision overloads the rigidizing force.",
           "scenarios `data/scenarios/ssrms_rigidize.toml` (ball joint on springs, as in the paper) and "
           "`ssrms_rigidize_wires.toml` (computed wires). 1.3 t as printed, "
           "and 13 t, since the paper calls its visitor similar to the HTV.",
           {{"Force of the pull", time, force}, {"Force between plate and end effector", time, force}},
           {{"ball joint, 1.3 t", by_ball_joint, "snare::carriage torque_N", 0},
            {"three wires, 1.3 t", by_wires, "snare::carriage torque_N", 0},
            {"ball joint, 13 t", heavy, "snare::carriage torque_N", 0},
            {"ball joint, 1.3 t", by_ball_joint, "plate on face normal_N", 1},
            {"three wires, 1.3 t", by_wires, "plate on face normal_N", 1},
            {"ball joint, 13 t", heavy, "plate on face normal_N", 1}},
           figure_12}};
}

std::vector<Figure> constraint_figures() {
  return {{"Fig. 16", "Translation along x", "The pin is moved by 3 mm to either side.", test_method,
           readings, translation(legs[0])},
          {"Fig. 17", "Translation along y", "The pin is moved by 3 mm to either side.", test_method,
           readings, translation(legs[1])},
          {"Fig. 18", "Translation along z", "The pin is moved by 10 mm to either side along its axis.",
           test_method, readings, translation(legs[2])},
          {"Fig. 19",
           "Deflection-force curves",
           "Along x and y linear with slight hysteresis; along z not linear, with constant friction and "
           "clear hysteresis.",
           "The constraint test, and at rest a half-scale shaft in the seat of the closed wires.",
           {{"Along x", deflection, force}, {"Along y", deflection, force}, {"Along z", deflection, force}},
           {},
           figure_19,
           "shaft in a closed snare"}};
}

std::vector<Lost> lost() {
  return {{"Figs. 1 to 5, 7, 13 to 15", "photographs and sketches; nothing is computed for them"},
          {"Fig. 6, stiffness of a joint with backlash",
           "drawn only, no value is printed; the arm has assumed joints"},
          {"Table 1, conditions of contact", "its values are missing in the text; four pairs are assumed"},
          {"Table 3, start of the rigidizing",
           "garbled in the text; a misalignment of -0.12 m can be read, the rest as zero"},
          {"curves of Figs. 10 to 12", "drawn only; their values and axes are not in the text"},
          {"readings of Figs. 16 to 19",
           "drawn only; forces and torques are not in the text, so that shapes alone can be compared"},
          {"mass of the visitor",
           "printed as 1.3 t and as \"similar to HTV\", which has 16 t; 13 t is computed too"},
          {"sizes and stiffnesses of the end effector, joints of the arm", "not printed: assumed"}};
}

}  // namespace

const Paper& na() {
  static const Paper paper{
      "na",
      "The paper on spacecraft capture by a large manipulator with an end effector of three wires (title "
      "and authors are not known here)",
      "the paper on an end effector of three wires", joined({contact_figures(), constraint_figures()}),
      lost()};
  return paper;
}

}  // namespace snare::papers
