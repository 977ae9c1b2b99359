// Every allocation of the readers fails once: they throw std::bad_alloc (or say what is wrong with the input), leak nothing, and read
// the same file the next time.

#include "tests/faults/failing_new.hpp"
#include "tests/fuzz/model_readers.hpp"
#include "tests/fuzz/readers.hpp"
#include "tests/identification/valid_experiment.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <string>

namespace snare {
namespace {

/// How many allocations failed, one a call, before one call met none.
long fail_each(const std::function<bool()>& read) {
  constexpr long most = 200'000;
  for (long at = 1; at < most; ++at) {
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
      "<robot name='r'><link name='a'/><link name='b'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' "
      "ixy='0' "
      "ixz='0' iyz='0'/></inertial></link><joint name='j' type='continuous'><parent link='a'/><child "
      "link='b'/></joint></robot>";
  EXPECT_GT(fail_each([&] { return fuzz::read_bytes_as_urdf(robot); }), 50);
}

TEST(Allocations, Meshes) {
  EXPECT_GT(fail_each([] { return fuzz::read_bytes_as_mesh("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ".off"); }),
            3);
}

}  // namespace
}  // namespace snare
