#include "validation/air_table_checks.hpp"

#include <gtest/gtest.h>

namespace snare::validation {
namespace {

void expect_within(const std::vector<Row>& rows) {
  ASSERT_FALSE(rows.empty());
  for (const Row& row : rows) EXPECT_TRUE(row.within()) << row.name << ": " << row.value << " against " << row.reference;
}

TEST(AirTable, QuadraticLawKeepsItsEnergyBalance) { expect_within(quadratic_law_rows()); }

TEST(SlowAirTable, LawKeepsTheImpulseOfTheFullWire) { expect_within(law_beside_wire_rows()); }

}  // namespace
}  // namespace snare::validation
