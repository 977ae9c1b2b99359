#include "base/errors.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace snare::base {
namespace {

TEST(InputProblem, MessageNamesFileLineKeyValueAndRequirement) {
  const InputProblem problem{.file = "data/x.toml",
                             .line = 12,
                             .key = "wire.diameter_mm",
                             .value = "-1.5",
                             .requirement = "must be > 0"};
  EXPECT_EQ(problem.message(), "data/x.toml:12: wire.diameter_mm = -1.5, must be > 0");
}

TEST(InputProblem, UnknownLineIsLeftOut) {
  const InputProblem problem{
      .file = "x.toml", .line = 0, .key = "wire", .value = "", .requirement = "is missing"};
  EXPECT_EQ(problem.message(), "x.toml: wire, is missing");
}

TEST(InputProblem, ProblemOfAWholeFileHasNoKey) {
  const InputProblem problem{
      .file = "x.toml", .line = 0, .key = "", .value = "", .requirement = "is a directory"};
  EXPECT_EQ(problem.message(), "x.toml: is a directory");
}

TEST(InputProblem, ProblemOutsideAFileBeginsWithTheKey) {
  const InputProblem problem{
      .file = "", .line = 0, .key = "threads", .value = "0", .requirement = "must be at least 1"};
  EXPECT_EQ(problem.message(), "threads = 0, must be at least 1");
}

TEST(InputError, WhatHasOneLinePerProblemInTheGivenOrder) {
  const InputError error{std::vector<InputProblem>{
      {.file = "x.toml", .line = 3, .key = "b", .value = "nan", .requirement = "must be finite"},
      {.file = "x.toml", .line = 1, .key = "a", .value = "2", .requirement = "must be < 1"}}};
  EXPECT_STREQ(error.what(), "x.toml:3: b = nan, must be finite\nx.toml:1: a = 2, must be < 1");
  ASSERT_EQ(error.problems().size(), 2u);
  EXPECT_EQ(error.problems()[0].key, "b");
  EXPECT_EQ(error.problems()[1].key, "a");
}

TEST(InputError, CanBeThrownWithASingleProblem) {
  try {
    throw InputError(InputProblem{.file = "", .line = 0, .key = "k", .value = "v", .requirement = "r"});
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "k = v, r");
    EXPECT_EQ(error.problems().size(), 1u);
  }
}

TEST(LibraryError, WhatNamesFunctionCodeAndMeaning) {
  const LibraryError error("KINSol", -11, "the linear solver's set-up failed");
  EXPECT_STREQ(error.what(), "KINSol returned -11: the linear solver's set-up failed");
  EXPECT_EQ(error.code(), -11);
}

}  // namespace
}  // namespace snare::base
