// Every allocation of the readers fails once: they throw std::bad_alloc (or say what is wrong with the
// input), leak nothing, and read the same file the next time.

#include "base/files.hpp"
#include "tests/faults/failing_new.hpp"
#include "tests/fuzz/file_readers.hpp"
#include "tests/fuzz/model_readers.hpp"
#include "tests/fuzz/readers.hpp"
#include "tests/identification/valid_experiment.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <string_view>

namespace snare {
namespace {

/// How many allocations failed, one a call, before one call met none. stride: of readers with many, every
/// so-many-th.
long fail_each(const std::function<bool()>& read, long stride = 1) {
  constexpr long most = 1'000'000;
  for (long at = 1; at < most; at += stride) {
    test::allocations_left = at;
    bool read_on = false;
    bool accepted = false;
    try {
      accepted = read();
      read_on = true;
    } catch (const std::bad_alloc&) {
    }
    const bool met = test::allocations_left == 0;
    test::allocations_left = 0;
    if (met) continue;  // where a library took a failed allocation for a wrong input, it has said so
    EXPECT_TRUE(read_on && accepted);
    return at - 1;
  }
  ADD_FAILURE() << "more allocations than expected";
  return most;
}

TEST(Allocations, Csv) {
  EXPECT_GT(fail_each([] {
              return fuzz::read_bytes_as_csv("displacement_mm,force_N,time_s\n0,0,0\n0.1,\"0.5\",1 # more\n");
            }),
            5);
}

TEST(Allocations, Experiment) {
  EXPECT_GT(fail_each([] { return fuzz::read_bytes_as_experiment(identification::valid_experiment); }), 100);
}

TEST(Allocations, RobotDescription) {
  const std::string robot =
      "<robot name='r'><link name='a'/><link name='b'><inertial><mass value='1'/><inertia ixx='1' iyy='1' "
      "izz='1' "
      "ixy='0' "
      "ixz='0' iyz='0'/></inertial></link><joint name='j' type='continuous'><parent link='a'/><child "
      "link='b'/></joint></robot>";
  EXPECT_GT(fail_each([&] { return fuzz::read_bytes_as_urdf(robot); }), 50);
}

TEST(Allocations, Meshes) {
  EXPECT_GT(fail_each([] {
              return fuzz::read_bytes_as_mesh("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ".off");
            }),
            3);
}

/// Readers of files that name others have thousands: a prime number of them are passed over each time.
void fail_file(const char* file, bool (*read)(std::string_view), long stride) {
  const std::string text = base::read_text(std::filesystem::path(SNARE_SOURCE_DIR) / file);
  ASSERT_TRUE(read(text)) << file;
  EXPECT_GT(fail_each([&] { return read(text); }, stride), 50) << file;
}

TEST(Allocations, Arm) {
  fail_file("data/arms/jemrms_like.toml", fuzz::read_bytes_as_arm, 31);
}

TEST(Allocations, Scenario) {
  fail_file("tests/ranges/composed.toml", fuzz::read_bytes_as_scenario, 97);
}

TEST(Allocations, Record) {
  fail_file("tests/ranges/record.toml", fuzz::read_bytes_as_record, 31);
}

TEST(Allocations, Sweep) {
  fail_file("tests/ranges/sweep.toml", fuzz::read_bytes_as_sweep, 7);
}

TEST(Allocations, Wire) {
  fail_file("tests/ranges/wire.toml", fuzz::read_bytes_as_wire, 7);
}

TEST(Allocations, JournalOfASweep) {
  const auto read = [] { return fuzz::read_bytes_as_journal("snare-journal/1 identity\n"); };
  ASSERT_TRUE(read());  // the folder of the files is made outside of what fails
  EXPECT_GT(fail_each(read), 3);
}

}  // namespace
}  // namespace snare
