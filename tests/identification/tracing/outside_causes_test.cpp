#include "identification/tracing/outside_causes.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace snare::identification {
namespace {

constexpr double kExplained = 230.0;  // chi2 with the effect

/// A function that does as well as the effect in all respects.
ChannelFunction function(Channel channel, double carried_over) {
  ChannelFunction f;
  f.channel = channel;
  f.carried_over = carried_over;
  f.accepted = carried_over > 0.7;
  f.chi2 = kExplained;
  return f;
}

std::size_t rivals(const ChannelFunction& f, const std::vector<std::string>& names, double predicted) {
  return rivals_outside({f}, names, kExplained, predicted).size();
}

TEST(OutsideCauses, PredictConditionsLeftOutAsWellAsTheEffectDoes) {
  const std::vector<std::string> names{"contact_position"};
  EXPECT_EQ(rivals(function(Channel::wire, 0.80), names, 0.82), 1U);
  EXPECT_EQ(rivals(function(Channel::wire, 0.80), names, 0.90), 0U);
  EXPECT_EQ(rivals(function(Channel::wire, 1.00), names, 1.20), 1U);  // more than all is luck
  EXPECT_EQ(rivals(function(Channel::wire, 0.92), names, 1.20), 0U);
  EXPECT_EQ(rivals(function(Channel::wire, 0.60), names, 0.50), 0U);  // not accepted by itself
  ChannelFunction worse = function(Channel::wire, 1.0);
  worse.chi2 += 7.0;
  EXPECT_EQ(rivals(worse, names, 1.0), 0U);
}

TEST(OutsideCauses, AreNoMemberOfTheClassInOtherWords) {
  ChannelFunction apart = function(Channel::mount, 1.0);
  apart.constant = "mount.span_mm";
  EXPECT_EQ(rivals(apart, {"contact_position"}, 1.0), 1U);
  EXPECT_EQ(rivals(apart, {"wire_length"}, 1.0), 1U);
  EXPECT_EQ(rivals(apart, {"wire_length", "span"}, 1.0), 0U);                    // which it is without slope
  EXPECT_EQ(rivals(apart, {"wire_length", "mount_axial_compliance"}, 1.0), 0U);  // of the same channel
}

TEST(OutsideCauses, SeveralEffectsGiveWayToOneOfWhichNearlyAllCarriesOver) {
  EXPECT_FALSE(one_for_several({}));
  EXPECT_FALSE(one_for_several({function(Channel::wire, 0.85)}));
  EXPECT_TRUE(one_for_several({function(Channel::wire, 0.85), function(Channel::sensor, 0.95)}));
}

}  // namespace
}  // namespace snare::identification
