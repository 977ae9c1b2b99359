#include "validation/air_table_checks.hpp"

#include "tests/validation/row_checks.hpp"

#include <gtest/gtest.h>

namespace snare::validation {
namespace {

TEST(AirTable, QuadraticLawKeepsItsEnergyBalance) {
  expect_within(quadratic_law_rows());
}

TEST(SlowAirTable, LawKeepsTheImpulseOfTheFullWire) {
  expect_within(law_beside_wire_rows());
}

}  // namespace
}  // namespace snare::validation
