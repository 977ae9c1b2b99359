#include "validation/air_table_checks.hpp"

#include "tests/validation/row_checks.hpp"

#include <gtest/gtest.h>

#include <string>

namespace snare::validation {
namespace {

const std::string data = std::string(SNARE_SOURCE_DIR) + "/data";

TEST(AirTable, QuadraticLawKeepsItsEnergyBalance) {
  expect_within(quadratic_law_rows(data));
}

}  // namespace
}  // namespace snare::validation
