#include "identification/published/published_map.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace snare::identification {

namespace {

constexpr double mm = 1e-3, degree = 0.017453292519943295;

PriorNumber logarithmic(const char* key, double lower, double upper) {
  return {key, lower, upper, true};
}
PriorNumber even(const char* key, double half) {
  return {key, -half, half, false};
}

const PriorNumber bending = logarithmic("wire.bending_stiffness_Nm2", 0.01, 2.0);
const PriorNumber axial = logarithmic("wire.axial_stiffness_N", 0.005, 2.0);
const PriorNumber length = even("wire.length_mm", 3.0 * mm);
const PriorNumber mounts_give = logarithmic("mount_axial_compliance.compliance_m_N", 1e-7, 1e-4);
const PriorNumber left_gives = logarithmic("mount_axial_compliance_left.compliance_m_N", 1e-7, 1e-4);
const PriorNumber clamps_turn = logarithmic("mount_rotational_compliance.compliance_rad_Nm", 0.01, 10.0);
const PriorNumber friction{"pusher.friction", 0.0, 0.6, false};

PriorNumber slip(const char* key) {
  return logarithmic(key, 0.5, 1000.0);
}

}  // namespace

std::vector<Hypothesis> published_hypotheses() {
  const auto one = [](const char* name, const char* meaning, std::vector<PriorNumber> numbers = {},
                      void (*change)(coupling::PushProblem&) = nullptr, bool decimal_point = false) {
    const bool along = std::ranges::any_of(numbers, [](const PriorNumber& n) {
      return n.key == axial.key || n.key == mounts_give.key || n.key == left_gives.key;
    });
    return Hypothesis{name,   meaning,      along ? along_the_wire : name, std::move(numbers),
                      change, decimal_point};
  };
  const auto misprinted = [&](const char* name, const char* meaning, std::vector<PriorNumber> numbers = {}) {
    return one(name, meaning, std::move(numbers), nullptr, true);
  };
  return {
      one("declared", "wire and bench as declared"),
      one("bending_stiffness", "another bending stiffness", {bending}),
      one("axial_stiffness", "another axial stiffness", {axial}),
      one("wire_length", "another length of the wire", {length}),
      one("span", "another distance of the mounts", {even("mount.span_mm", 3.0 * mm)}),
      one("contact_position", "the pusher stands elsewhere along the wire",
          {even("contact_position.shift_mm", 3.0 * mm)}),
      one("push_misalignment", "the pusher moves askew", {even("pusher.misalignment_deg", 5.0 * degree)}),
      one("mount_axial_compliance", "the mounts give way along the wire", {mounts_give}),
      one("mount_axial_compliance_left", "one mount gives way along the wire", {left_gives}),
      one("mount_rotational_compliance", "the clamps turn", {clamps_turn}),
      one("mount_slip", "the wire slips in its left mount", {slip("mount_slip.tension_N")}),
      one("mount_slip_right", "the wire slips in its right mount", {slip("mount_slip_right.tension_N")}),
      one("clamp_slide", "the left mount slides", {slip("clamp_slide.tension_N")}),
      one("clamp_slide_right", "the right mount slides", {slip("clamp_slide_right.tension_N")}),
      one("clamp_slide_both", "both mounts slide", {slip("clamp_slide_both.tension_N")}),
      one("contact_friction", "the pusher rubs", {friction}),
      one("pusher_compliance", "the pusher gives way", {logarithmic("pusher.compliance_m_N", 1e-7, 1e-4)}),
      one("force_gain", "the load cell reads a multiple", {logarithmic("reading.force_gain", 0.5, 2.0)}),
      one("force_offset", "the load cell has another zero", {even("reading.force_offset_N", 2.0)}),
      one("natural_curvature", "the free wire is curved", {even("wire.natural_curvature_1_m", 5.0)}),
      one("plasticity", "the wire yields", {logarithmic("plasticity.yield_stress_MPa", 1e8, 2e9)}),
      one("pinned", "the ends turn freely", {},
          [](coupling::PushProblem& p) { p.mount.kind = wire::MountKind::pinned; }),
      one("inward", "the push is against the bulge", {},
          [](coupling::PushProblem& p) { p.pusher.direction = coupling::PushDirection::inward; }),
      one("rope", "the wire is a rope: both stiffnesses are others", {bending, axial}),
      one("rope_of_another_length", "the wire is a rope of another length", {bending, axial, length}),
      one("mounts_give_and_length", "the mounts give way, another length", {mounts_give, length}),
      one("mounts_give_and_bending", "the mounts give way, another bending stiffness",
          {mounts_give, bending}),
      one("mounts_give_and_turn", "the mounts give way and turn", {mounts_give, clamps_turn}),
      one("mounts_give_and_friction", "the mounts give way, the pusher rubs", {mounts_give, friction}),
      one("mounts_give_and_slip", "the mounts give way, the wire slips",
          {mounts_give, slip("mount_slip.tension_N")}),
      one("slip_and_friction", "the wire slips, the pusher rubs", {slip("mount_slip.tension_N"), friction}),
      misprinted("decimal_point", "a decimal point slipped in B"),
      misprinted("mounts_give_and_decimal_point", "the mounts give way, a decimal point slipped in B",
                 {mounts_give}),
      misprinted("rope_and_decimal_point", "the wire is a rope, a decimal point slipped in B",
                 {bending, axial}),
  };
}

std::vector<QuadraticLaw> before_print(std::vector<QuadraticLaw> laws, const Hypothesis& hypothesis) {
  if (hypothesis.decimal_point)
    std::ranges::min_element(laws, {}, [](const QuadraticLaw& l) { return std::abs(l.b); })->b *= 100.0;
  return laws;
}

double more_compliance(const Experiment& experiment, const Hypothesis& hypothesis,
                       const std::vector<double>& values) {
  const wire::WireSpecification& wire = experiment.series.front().test.wire;
  double more = 0.0;
  for (std::size_t j = 0; j < values.size(); ++j) {
    if (hypothesis.numbers[j].key == mounts_give.key) more += 2.0 * values[j];
    if (hypothesis.numbers[j].key == left_gives.key) more += values[j];
    if (hypothesis.numbers[j].key == axial.key)
      more += wire.length / wire.axial_stiffness() * (1.0 / values[j] - 1.0);
  }
  return more;
}

}  // namespace snare::identification
