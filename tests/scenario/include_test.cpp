#include "scenario/include.hpp"

#include "base/errors.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "scenario/scenario.hpp"
#include "tests/support/folder_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace snare::scenario {
namespace {

using ::testing::HasSubstr;

const std::string head = "schema = \"snare-scenario/2\"\ntitle = \"a ring closes on a pin\"\n";
const std::string run = "duration_s = 0.06\noutput_interval_s = 0.01\n";

/// A snare with its pin, and what turns and watches it. In `scope`: as the reader of a part names it.
std::string snare_and_pin(const std::string& scope = "", const std::string& world = "world") {
  return fmt::format(R"([[snares]]
name = "{0}snare"
frame = "{1}"
position_mm = [10.0, 0.0, 0.0]
ring_radius_mm = 100.0
[snares.ring]
start_deg = 174.0
[snares.wire]
construction = "solid"
diameter_mm = 1.5
length_mm = 200.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
model = "stretched"
tight_N = 20.0
[[bodies]]
name = "{0}visitor"
frame = "{0}snare::fixed"
mass_kg = 5.0
inertia_kg_m2 = [1.0, 1.0, 1.0]
position_mm = [2.0, 1.0, 0.0]
[[shapes]]
name = "{0}pin"
frame = "{0}visitor"
kind = "capsule"
radius_mm = 6.0
length_mm = 60.0
wires = ["{0}snare::wire_1", "{0}snare::wire_2", "{0}snare::wire_3"]
[[shapes]]
name = "{0}rim"
frame = "{0}snare::housing"
kind = "ring"
inner_radius_mm = 112.0
outer_radius_mm = 120.0
length_mm = 20.0
wires = []
[[contacts]]
name = "{0}pin in rim"
shape = "{0}rim"
other_shape = "{0}pin"
model = "spring_dashpot"
k_N_m = 1.0e5
[[drives]]
joint = "{0}snare::ring"
mode = "course"
to_deg = 178.0
rate_deg_s = 58.0
[[sensors]]
name = "{0}place"
kind = "position"
frame = "{0}visitor"
relative_to = "{1}"
[[sensors]]
name = "{0}touch"
kind = "contact_force"
contact = "{0}pin on {0}snare::wire_1"
[[sensors]]
name = "{0}knock"
kind = "contact_force"
contact = "{0}pin in rim"
)",
                     scope, world);
}

class Includes : public test::FolderFixture {
 protected:
  [[nodiscard]] WireMotions read(const std::string& name,
                                 const std::vector<std::string>& settings = {}) const {
    std::vector<base::Override> overrides;
    for (const std::string& s : settings) overrides.push_back(base::parse_override(s));
    return read_scenario(path(name), overrides).motions;
  }
  [[nodiscard]] std::string complaint(const std::string& name,
                                      const std::vector<std::string>& settings = {}) const {
    try {
      (void)read(name, settings);
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "none";
  }
  static std::string included(const std::string& name, const std::string& file,
                              const std::string& more = "") {
    return fmt::format("[[include]]\nname = \"{}\"\nfile = \"{}\"\n{}", name, file, more);
  }
};

/// Where the shaft is at the end, of the body that ends with this name.
Eigen::Vector3d end_of(const WireMotions& motions, const std::string& name) {
  const NamedMotion& one = motions.runs.front();
  std::vector<multibody::RigidBodyState> last;
  const auto result = coupling::simulate(one.motion, one.options, [&last](const coupling::MotionSample& s) {
    last = s.bodies;
    return false;
  });
  EXPECT_TRUE(result.report.usable()) << result.report.message;
  for (std::size_t b = 0; b < one.motion.bodies.size(); ++b)
    if (one.motion.bodies[b].name == name) return last.at(b).position;
  ADD_FAILURE() << "no " << name;
  return {};
}

// A part means what its lines would mean where they are included, with their names in its scope.
TEST_F(Includes, MeanWhatTheirLinesMean) {
  std::filesystem::create_directory(path("parts"));
  write("parts/part.toml", head + snare_and_pin());
  write("case.toml", head + run +
                         included("ee", "parts/part.toml",
                                  "position_mm = [0.0, 30.0, 0.0]\nrpy_deg = [0.0, 0.0, 20.0]\n"));
  write("whole.toml",
        head + run +
            "[[frames]]\nname = \"ee\"\nposition_mm = [0.0, 30.0, 0.0]\nrpy_deg = [0.0, 0.0, 20.0]\n" +
            snare_and_pin("ee_", "ee"));

  const WireMotions parts = read("case.toml"), whole = read("whole.toml");
  EXPECT_EQ(parts.runs.front().motion.law_wires.front().name, "ee::snare::wire_1");
  ASSERT_EQ(parts.sensors.size(), 3u);
  EXPECT_EQ(parts.sensors[0].name, "ee::place");
  const std::vector<std::string> contacts = parts.runs.front().motion.contact_names();
  EXPECT_EQ(contacts.at(static_cast<std::size_t>(parts.sensors[1].index)), "ee::pin on ee::snare::wire_1");
  EXPECT_EQ(contacts.at(static_cast<std::size_t>(parts.sensors[2].index)), "ee::pin in rim");
  const Eigen::Vector3d here = end_of(parts, "ee::visitor"), there = end_of(whole, "ee_visitor");
  EXPECT_EQ(here, there);
  EXPECT_GT((here - parts.runs.front().motion.bodies.front().start.position).norm(),
            1e-5);  // the wires have moved it
}

TEST_F(Includes, StandSideBySideAndInEachOther) {
  write("one.toml", head + snare_and_pin());
  write("two.toml", head + included("left", "one.toml", "position_mm = [-400.0, 0.0, 0.0]\n") +
                        included("right", "one.toml", "position_mm = [400.0, 0.0, 0.0]\n"));
  write("case.toml", head + run + included("pair", "two.toml", "position_mm = [0.0, 0.0, 50.0]\n"));
  const WireMotions all = read("case.toml", {"snares[pair::right::snare].ring.start_deg=170",
                                             "include[pair].position_mm=[0.0, 0.0, 70.0]"});
  const coupling::Motion& m = all.runs.front().motion;
  ASSERT_EQ(m.bodies.size(), 2u);
  EXPECT_EQ(m.bodies[0].name, "pair::left::visitor");
  EXPECT_NEAR((m.bodies[0].start.position - Eigen::Vector3d(-0.388, 0.001, 0.07)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((m.bodies[1].start.position - Eigen::Vector3d(0.412, 0.001, 0.07)).norm(), 0.0, 1e-12);
  EXPECT_EQ(m.law_wires.size(), 6u);
}

TEST_F(Includes, SayWhatIsWrong) {
  write("part.toml", head + snare_and_pin());
  write("worse.toml", head + snare_and_pin() + "speed = 1.0\n");
  write("phases.toml", head + snare_and_pin() + "[[phases]]\nname = \"x\"\n");
  write("older.toml", "schema = \"snare-scenario/1\"\n");
  write("itself.toml", head + run + included("a", "other.toml"));
  write("other.toml", head + included("b", "itself.toml"));
  const std::pair<std::string, std::string> cases[] = {
      {included("a", "none.toml"), "none.toml: no such file"},
      {included("a", "worse.toml"), "worse.toml:64: sensors[a::knock].speed = 1.0, unknown key"},
      {included("a", "phases.toml"), "phases.toml:64: phases, belongs to the file that includes this one"},
      {included("a", "older.toml"),
       "older.toml:1: schema = \"snare-scenario/1\", must be \"snare-scenario/2\""},
      {included("a::b", "part.toml"), "must be a name of its own"},
      {included("a", "part.toml") + included("a", "part.toml"), "is taken by another part"},
      {included("a", "part.toml", "place = 1.0\n"), "unknown key"},
      {included("a", "part.toml", "frame = \"nowhere\"\n"), "must be the name of a frame"},
      {"[[include]]\nname = \"a\"\n", "include[a].file, missing"},
      {included("a", "part.toml") +
           "[[sensors]]\nname = \"a::x\"\nkind = \"tension\"\nwire = \"a::snare::wire_1\"\n",
       "must not have \"::\""},
      {included("a", "part.toml") +
           "[[bodies]]\nname = \"a\"\nmass_kg = 1.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n",
       "is taken by a body"},
  };
  for (const auto& [text, message] : cases) {
    write("case.toml", fmt::format("{}{}{}", head, run, text));
    EXPECT_THAT(complaint("case.toml"), HasSubstr(message)) << text;
  }
  EXPECT_THAT(complaint("itself.toml"), HasSubstr("must not include itself by way of others"));
  write("case.toml", head + run + included("a", "part.toml"));
  EXPECT_THAT(complaint("case.toml", {"include[b].file=\"x\""}), HasSubstr("no such include; there are: a"));
  EXPECT_THAT(complaint("case.toml", {"bodies[a::visitor].mass_kg=-1"}),
              HasSubstr("--set: bodies[a::visitor].mass_kg"));
}

}  // namespace
}  // namespace snare::scenario
