#include "reduction/mujoco_text.hpp"

#include "base/one_line.hpp"
#include "reduction/export_text.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace snare::reduction {

namespace {

using Eigen::Vector3d;

constexpr double far_below = 1000.0;  // the lower end of a dead band lies so far below first touch [m]
constexpr double damper_share = 1.0 / 200.0;  // half width of the damper's sites over the travel

/// Sites and a pin of one wrapped tendon, or of several that begin at other travels.
struct Wrap {
  std::string suffix;
  double start = 0.0, half_width = 0.0;
  std::string attributes;  // of its tendon
};

std::vector<Wrap> wraps_of(const MujocoLaw& law, MujocoForm form) {
  std::vector<Wrap> wraps;
  if (form == MujocoForm::law && law.dashpot && law.dashpot->damping > 0.0) {
    // The elongation grows twice as fast as the travel: c/4 along the tendon is c along the travel.
    wraps.push_back({"damper", 0.0, damper_share * law.end,
                     fmt::format("stiffness=\"0\" damping=\"{}\"", 0.25 * law.dashpot->damping)});
  }
  if (form != MujocoForm::loop || !law.loop) return wraps;
  for (const MujocoSlider& s : law.loop->sliders) {
    wraps.push_back({fmt::format("slip_{}", wraps.size() + 1), s.start, s.half_width,
                     fmt::format("stiffness=\"{}\" springlength=\"{}\" springyield=\"{}\" damping=\"0\"",
                                 s.tension / s.yield, 2.0 * s.half_width, s.yield)});
  }
  return wraps;
}

std::string vector_text(const Vector3d& v) {
  return fmt::format("{} {} {}", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

/// Along the wire: a direction across the push.
Vector3d across(const Vector3d& axis) {
  const Vector3d other = std::abs(axis.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  return (other - other.dot(axis) * axis).normalized();
}

const std::vector<MujocoSpring>& springs_of_form(const MujocoLaw& law, MujocoForm form) {
  return form == MujocoForm::loop && law.loop ? law.loop->springs : law.springs;
}

/// Text for a comment of XML, in which a double hyphen is not allowed.
std::string comment_safe(std::string words) {
  for (std::size_t at = words.find("--"); at != std::string::npos; at = words.find("--", at))
    words.insert(at + 1, " ");
  return words;
}

std::string tendon(const MujocoTie& tie, const std::string& name, const Vector3d& stiffness, double start,
                   bool one_number) {
  const std::string numbers = one_number ? fmt::format("{}", stiffness[0])
                                         : fmt::format("{} {} {}", stiffness[0], stiffness[1], stiffness[2]);
  const double from = tie.first_touch + start;
  if (tie.joint.empty()) {
    return fmt::format(
        "    <spatial name=\"{}\" stiffness=\"{}\" springlength=\"0 {}\" damping=\"0\" limited=\"false\" "
        "width=\"0.0001\">\n"
        "      <site site=\"{}_far\"/><site site=\"{}_point\"/>\n    </spatial>\n",
        name, numbers, from, tie.name, tie.name);
  }
  return fmt::format(
      "    <fixed name=\"{}\" stiffness=\"{}\" springlength=\"{} {}\" damping=\"0\" limited=\"false\">\n"
      "      <joint joint=\"{}\" coef=\"{}\"/>\n    </fixed>\n",
      name, numbers, from - far_below, from, tie.joint, tie.coefficient);
}

}  // namespace

const char* file_of(MujocoForm form) {
  switch (form) {
    case MujocoForm::loop:
      return "law_mujoco_loop.xml";
    case MujocoForm::linear:
      return "law_mujoco_linear.xml";
    case MujocoForm::law:
      break;
  }
  return "law_mujoco.xml";
}

const char* readers_of(MujocoForm form) {
  switch (form) {
    case MujocoForm::loop:
      return "MuJoCo 4.0.0 and later (springyield)";
    case MujocoForm::linear:
      return "MuJoCo (tried: 3.2.0, 3.6.0, 3.17.0, 4.0.0), MuJoCo Warp, MJX 3.17.0, SolverMuJoCo of Newton "
             "1.8.0";
    case MujocoForm::law:
      break;
  }
  return "MuJoCo 3.7.0 and later (stiffness of three numbers; tried: 3.17.0, 4.0.0), MuJoCo Warp; not MJX, "
         "Newton, "
         "Drake";
}

bool has_form(const MujocoLaw& law, MujocoForm form) {
  return form != MujocoForm::loop || law.loop.has_value();
}

std::string mujoco_words(const MujocoLaw& law, MujocoForm form) {
  std::string words = fmt::format("s = {:.6g} mm, travel 0 to {:.6g} mm, {:.5g} N at its end",
                                  1e3 * law.position, 1e3 * law.end, law.force_range);
  if (form == MujocoForm::linear)
    return words + fmt::format("; one number, wrong by up to {:.3g} N within the travel", law.linear_error);
  words += "; straight beyond it";
  if (form == MujocoForm::loop)
    return words + fmt::format(
                       "; a repeated cycle over the travel loses {:.4g} J at any rate, both branches within "
                       "{:.3g} N of "
                       "the load/unload law",
                       law.loop->energy, law.loop->largest_error);
  if (law.dashpot)
    words +=
        fmt::format("; damping in contact of an impact at {:.4g} m/s, c = {:.4g} N s/m, restitution {:.5g}",
                    law.dashpot->speed, law.dashpot->damping, law.dashpot->restitution);
  return words;
}

std::string mujoco_tendons(const MujocoLaw& law, MujocoForm form, const MujocoTie& tie) {
  std::string text;
  if (form == MujocoForm::linear) {
    text = tendon(tie, tie.name + "_1", {law.linear_stiffness, 0.0, 0.0}, 0.0, true);
  } else {
    int number = 0;
    for (const MujocoSpring& s : springs_of_form(law, form))
      text += tendon(tie, fmt::format("{}_{}", tie.name, ++number), s.stiffness, s.start, false);
  }
  if (tie.joint.empty()) return text;
  for (const Wrap& w : wraps_of(law, form)) {
    text += fmt::format(
        "    <spatial name=\"{0}_{1}\" {2} limited=\"false\" width=\"0.0001\">\n"
        "      <site site=\"{0}_{1}_left\"/><geom geom=\"{0}_pin\" sidesite=\"{0}_side\"/><site "
        "site=\"{0}_{1}_right\"/>\n"
        "    </spatial>\n",
        tie.name, w.suffix, w.attributes);
  }
  return text;
}

std::string mujoco_anchors(const MujocoLaw& law, MujocoForm form, const MujocoTie& tie) {
  if (tie.joint.empty())
    return fmt::format("      <site name=\"{}_far\" pos=\"{}\" size=\"0.0001\"/>\n", tie.name,
                       vector_text(tie.point - mujoco_far_site * tie.axis));
  std::string text;
  const Vector3d along = across(tie.axis);
  for (const Wrap& w : wraps_of(law, form)) {
    const Vector3d at = tie.point + (tie.advance + w.start) * tie.axis;
    text += fmt::format(
        "      <site name=\"{0}_{1}_left\" pos=\"{2}\" size=\"0.0001\"/><site name=\"{0}_{1}_right\" "
        "pos=\"{3}\" "
        "size=\"0.0001\"/>\n",
        tie.name, w.suffix, vector_text(at - w.half_width * along), vector_text(at + w.half_width * along));
  }
  return text;
}

std::string mujoco_pin(const MujocoLaw& law, MujocoForm form, const MujocoTie& tie) {
  if (tie.joint.empty())
    return fmt::format("      <site name=\"{}_point\" pos=\"{}\" size=\"0.0001\"/>\n", tie.name,
                       vector_text(tie.point));
  const std::vector<Wrap> wraps = wraps_of(law, form);
  if (wraps.empty()) return {};
  const double radius = mujoco_pin_share * wraps.front().half_width;
  return fmt::format(
      "      <geom name=\"{0}_pin\" type=\"sphere\" size=\"{1}\" pos=\"{2}\" mass=\"0\" contype=\"0\" "
      "conaffinity=\"0\"/>\n"
      "      <site name=\"{0}_side\" pos=\"{3}\" size=\"0.0001\"/>\n",
      tie.name, radius, vector_text(tie.point - radius * tie.axis),
      vector_text(tie.point + 3.0 * radius * tie.axis));
}

std::string mujoco_file(const std::vector<MujocoLaw>& laws, MujocoForm form, const std::string& title) {
  std::string bodies, tendons, ranges, sensors;
  for (const MujocoLaw& law : laws) {
    if (!has_form(law, form)) continue;
    const std::string name = position_name(law.position);
    const MujocoTie tie{"wire_" + name,    "wire_travel_" + name, 1.0, 0.0,
                        Vector3d::UnitY(), Vector3d::Zero(),      0.0};
    const double mass = std::max(1e-3, std::stod(fmt::format("{:.2g}", 1.05 * sufficient_mass(law))));
    const std::string anchors = mujoco_anchors(law, form, tie);
    bodies += fmt::format("    <!-- {} -->\n", mujoco_words(law, form));
    if (!anchors.empty())
      bodies += fmt::format("    <body name=\"wire_anchor_{}\">\n{}    </body>\n", name, anchors);
    bodies += fmt::format(
        "    <body name=\"wire_contact_{0}\">\n      <joint name=\"wire_travel_{0}\" type=\"slide\" axis=\"0 "
        "1 0\"/>\n"
        "      <geom type=\"sphere\" size=\"0.01\" mass=\"{1}\" contype=\"0\" conaffinity=\"0\"/>\n{2}    "
        "</body>\n",
        name, mass, mujoco_pin(law, form, tie));
    tendons += mujoco_tendons(law, form, tie);
    ranges += fmt::format("    <numeric name=\"wire_travel_{}_range\" data=\"0 {}\"/>\n", name, law.end);
    sensors += fmt::format("    <jointpos name=\"wire_travel_{0}_now\" joint=\"wire_travel_{0}\"/>\n", name);
  }
  return fmt::format(
      "<!-- {}\n     Readers: {}.\n"
      "     Springs of the snare wire, travel from first touch: no force below it, in N and m. The springs "
      "are tendons "
      "with a dead\n"
      "     band on the joint of the body that meets the wire. `snare export` writes them onto a body of "
      "your own "
      "model; do not tie\n"
      "     a body to these ones by a weld or a contact, which is as soft as their mass is small.\n"
      "     wire_travel_*_range is the range [m]: beyond it wire_travel_*_now reads more than its second "
      "number. -->\n"
      "<mujoco model=\"snare_wire\">\n  <worldbody>\n{}  </worldbody>\n  <tendon>\n{}  </tendon>\n  "
      "<custom>\n{}  "
      "</custom>\n"
      "  <sensor>\n{}  </sensor>\n</mujoco>\n",
      comment_safe(base::one_line(title)), readers_of(form), bodies, tendons, ranges, sensors);
}

}  // namespace snare::reduction
