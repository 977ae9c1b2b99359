// Bodies whose centre of mass is not at the origin of their frame.
#include "scenario/scenario.hpp"

#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace snare::scenario {
namespace {

class CentreOfMass : public test::FolderFixture {
 protected:
  coupling::Motion read(const std::string& body, const std::string& load) const {
    return read_scenario(write("s.toml", R"(schema = "snare-scenario/2"
title = "a craft"
duration_s = 0.1
output_interval_s = 0.01
[[frames]]
name = "pad"
frame = "world"
position_mm = [10.0, 20.0, 30.0]
rotation_deg = [0.0, 0.0, 30.0]
[[bodies]]
name = "craft"
frame = "pad"
)" + body + "[[loads]]\nname = \"push\"\nframe = \"craft\"\nforce_N = [1.0, 0.0, 0.0]\n" +
                                             load))
        .motions.runs.at(0)
        .motion;
  }
};

constexpr const char* inertia =
    "mass_kg = 5.0\ninertia_kg_m2 = [1.0, 2.0, 2.5]\nrotation_deg = [0.0, 0.0, 90.0]\n";

// The frame at the origin with the centre 100 mm along x, and the frame at the centre: v + w x c is 0.01 m/s
// less along the pad's x.
TEST_F(CentreOfMass, IsTheSameBodyAsOneThatIsPlacedByIt) {
  const coupling::Motion aside =
      read(std::string(inertia) +
               "com_mm = [100.0, 0.0, 0.0]\nvelocity_m_s = [1.0, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.1]\n",
           "");
  const coupling::Motion centred = read(
      std::string(inertia) +
          "position_mm = [0.0, 100.0, 0.0]\nvelocity_m_s = [0.99, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.1]\n",
      "position_mm = [-100.0, 0.0, 0.0]\n");
  const multibody::RigidBodyState &a = aside.bodies.at(0).start, &b = centred.bodies.at(0).start;
  EXPECT_LT((a.position - b.position).norm(), 1e-15);
  EXPECT_LT((a.velocity - b.velocity).norm(), 1e-15);
  EXPECT_LT((a.spin - b.spin).norm(), 1e-15);
  EXPECT_LT(a.orientation.angularDistance(b.orientation), 1e-15);
  EXPECT_LT((aside.loads.at(0).X_WF.p - centred.loads.at(0).X_WF.p).norm(), 1e-15);
}

TEST_F(CentreOfMass, ADrivenBodyHasNone) {
  EXPECT_THAT(test::refusal([&] { return read("driven = true\ncom_mm = [1.0, 0.0, 0.0]\n", ""); }),
              testing::HasSubstr("bodies[craft].com_mm = [1.0, 0.0, 0.0], a driven body moves"));
}

}  // namespace
}  // namespace snare::scenario
