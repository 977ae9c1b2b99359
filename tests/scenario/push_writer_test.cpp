#include "scenario/push_writer.hpp"

#include "base/toml_reader.hpp"
#include "scenario/push_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>

namespace snare::scenario {
namespace {

using coupling::PushProblem;

PushProblem read_back(const std::string& text) {
  base::TomlDocument document("written.toml", text);
  PushProblem push = read_push_problem(push_tables(document.root()));
  document.finish();
  return push;
}

PushProblem plain() {
  PushProblem push;
  push.wire.diameter = 1.5e-3;
  push.wire.length = 175.4871234e-3;
  push.wire.youngs_modulus = 193e9;
  push.wire.poisson_ratio = 0.29;
  push.wire.density = 7930.0;
  push.wire.bending_stiffness_override = 0.00846123456789;
  push.wire.axial_stiffness_override = 17721.0;
  push.mount.span = 0.175;
  push.pusher.radius = 6e-3;
  return push;
}

// A number in a file is a decimal one: a unit in the last place (2^-52) or two are lost on the way.
constexpr double roundings = 1e-15;
void expect_same(double read, double written) {
  EXPECT_NEAR(read, written, roundings * std::abs(written));
}

TEST(PushWriter, APlainPushReadsAsItself) {
  const PushProblem push = plain();
  const std::string text = push_tables_text(push);
  const PushProblem read = read_back(text);
  expect_same(read.wire.diameter, push.wire.diameter);
  expect_same(read.wire.length, push.wire.length);
  expect_same(read.wire.bending_stiffness(), push.wire.bending_stiffness());
  expect_same(read.wire.axial_stiffness(), push.wire.axial_stiffness());
  expect_same(read.wire.torsional_stiffness(), push.wire.torsional_stiffness());
  expect_same(read.wire.density, push.wire.density);
  expect_same(read.mount.span, push.mount.span);
  expect_same(read.pusher.radius, push.pusher.radius);
  EXPECT_FALSE(read.mount.translational_stiffness || read.mount.rotational_stiffness ||
               read.mount.slip_tension);
  EXPECT_EQ(text.find("[bulge]"), std::string::npos) << "defaults are left out";
  EXPECT_EQ(text.find("[gravity]"), std::string::npos);
}

TEST(PushWriter, EveryKeyReadsAsItself) {
  PushProblem push = plain();
  push.wire.construction = wire::Construction::strand;
  push.wire.torsional_stiffness_override = 0.005;
  push.wire.natural_curvature = -1.25;
  push.wire.strand_friction = wire::StrandFriction{0.002, 3.5, 0.5};
  push.wire.yielding = wire::Yielding{181.8e6, 0.05};
  push.mount.translational_stiffness = 2.5e5;
  push.mount.rotational_stiffness = 12.5;
  push.mount.slip_tension = 80.0;
  push.mount.slip = wire::MountSlip::slides;
  push.mount.slip_at = wire::SlipPlace::both;
  push.pusher = {3e-3, 0.15, 2e-6, coupling::PushDirection::inward, 0.01, -0.02};
  push.bulge = {2, 0.3};
  push.gravity = {0.5, -9.81, 0.25};
  const PushProblem read = read_back(push_tables_text(push));
  EXPECT_EQ(read.wire.construction, push.wire.construction);
  expect_same(*read.wire.torsional_stiffness_override, 0.005);
  expect_same(read.wire.natural_curvature, -1.25);
  expect_same(read.wire.strand_friction->extra_stiffness, 0.002);
  expect_same(read.wire.strand_friction->slip_curvature, 3.5);
  expect_same(read.wire.strand_friction->breadth, 0.5);
  expect_same(read.wire.yielding->yield_stress, 181.8e6);
  expect_same(read.wire.yielding->hardening_ratio, 0.05);
  expect_same(*read.mount.translational_stiffness, 2.5e5);
  expect_same(*read.mount.rotational_stiffness, 12.5);
  expect_same(*read.mount.slip_tension, 80.0);
  EXPECT_EQ(read.mount.slip, wire::MountSlip::slides);
  EXPECT_EQ(read.mount.slip_at, wire::SlipPlace::both);
  expect_same(read.pusher.friction, 0.15);
  expect_same(read.pusher.compliance, 2e-6);
  EXPECT_EQ(read.pusher.direction, coupling::PushDirection::inward);
  expect_same(read.pusher.tilt, 0.01);
  expect_same(read.pusher.misalignment, -0.02);
  EXPECT_EQ(read.bulge.mode, 2);
  expect_same(read.bulge.plane, 0.3);
  for (std::size_t i = 0; i < 3; ++i) expect_same(read.gravity[i], push.gravity[i]);
}

TEST(PushWriter, SupportsReadAsThemselves) {
  PushProblem push = plain();
  push.mount.kind = wire::MountKind::supports;
  push.mount.support_radius = 4e-3;
  const PushProblem read = read_back(push_tables_text(push));
  EXPECT_EQ(read.mount.kind, wire::MountKind::supports);
  expect_same(read.mount.support_radius, 4e-3);
}

}  // namespace
}  // namespace snare::scenario
