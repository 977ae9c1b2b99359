#include "reduction/error_reason.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace snare::reduction {
namespace {

/// A wire that stiffens over 5 mm, and a model of it.
std::string reason_of(const std::function<double(double)>& model, bool back = false) {
  std::vector<double> travel, wire, forces;
  for (int i = 0; i <= 50; ++i) travel.push_back(1e-4 * i);
  if (back) travel.insert(travel.end(), travel.rbegin() + 1, travel.rend());
  for (const double d : travel) {
    wire.push_back(2e3 * d + 8e5 * d * d);
    forces.push_back(model(d));
  }
  return error_reason(travel, wire, forces);
}

double wire_force(double d) {
  return 2e3 * d + 8e5 * d * d;
}

TEST(ErrorReason, IsNoneForASmallError) {
  EXPECT_EQ(reason_of(wire_force), "");
  EXPECT_EQ(reason_of([](double d) { return 1.04 * wire_force(d); }), "");
}

TEST(ErrorReason, SaysHowManyTimesTooStiff) {
  EXPECT_EQ(reason_of([](double d) { return 3.0 * wire_force(d); }),
            "too stiff: 3 times the force of the wire at the same travel");
  EXPECT_EQ(reason_of([](double d) { return 0.25 * wire_force(d); }, true),
            "too soft: 0.25 of the force of the wire at the same travel");
}

TEST(ErrorReason, SaysWhereTheForceComesTooLateOrEarly) {
  // A law that counts from where the wire is taut.
  EXPECT_EQ(reason_of([](double d) { return d < 1e-3 ? 0.0 : wire_force(d - 1e-3); }),
            "its force comes 1 mm of travel too late");
  EXPECT_EQ(reason_of([](double d) { return wire_force(d + 0.5e-3); }),
            "its force comes 0.5 mm of travel too early");
}

TEST(ErrorReason, SaysWhatIsOffEverywhere) {
  EXPECT_EQ(reason_of([](double d) { return wire_force(d) + 3.0; }), "3 N too much everywhere");
  EXPECT_EQ(reason_of([](double d) { return wire_force(d) - 4.0; }), "4 N too little everywhere");
}

TEST(ErrorReason, SaysThatAStraightLineIsOfAnotherForm) {
  EXPECT_EQ(reason_of([](double d) { return 6e3 * d; }),
            "of another form: above the wire everywhere, farthest off at 2.5 mm");
}

TEST(ErrorReason, SaysOnWhichSideOfTheWireAModelIs) {
  EXPECT_EQ(reason_of([](double) { return 20.0; }),
            "of another form: above the wire at first and in the middle, below the wire at the end, farthest "
            "off at 0 mm");
}

}  // namespace
}  // namespace snare::reduction
