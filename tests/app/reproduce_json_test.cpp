#include "app/reproduce_json.hpp"

#include "tests/app/report/reproduce_fixture.hpp"
#include "tests/app/report/trace_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace snare::app {
namespace {

using nlohmann::json;

TEST(ReproduceJson, HasTheNumbersOfTheResult) {
  Reproduction result = reproduction();
  result.trace = explained_trace();
  const json j = reproduce_json(result);
  EXPECT_EQ(j["models"][1]["name"], "best_fit");
  EXPECT_EQ(j["models"][1]["free"], 1);
  EXPECT_EQ(j["models"][1]["parameters"]["wire.length_mm"]["stderr"], 0.0123);
  EXPECT_TRUE(j["models"][0]["parameters"]["wire.length_mm"]["stderr"].is_null());
  const json& series = j["series"][0];
  EXPECT_EQ(series["published"]["B_N_m"], 1000.0);
  EXPECT_EQ(series["range_mm"], 2.0);
  const json& best = series["models"]["best_fit"];
  EXPECT_EQ(best["force_N"], json({0.2, 1.2, 2.2}));
  EXPECT_EQ(best["max_N"], 2.2);
  EXPECT_NEAR(best["rmse_N"].get<double>(), 0.2, 1e-12) << "off by 0.2 N at every point, to round-off";
  EXPECT_EQ(best["shapes"][1]["displacement_mm"], 2.0);
  EXPECT_EQ(best["shapes"][1]["pusher_radius_mm"], 6.0);
  EXPECT_FALSE(best.contains("stopped"));
  EXPECT_EQ(j["trace"]["selected"], json::array({"plasticity"}));
  EXPECT_FALSE(j["trace"].contains("series")) << "without its curves";
}

TEST(ReproduceJson, SaysWhatIsMissing) {
  Reproduction result = reproduction();
  result.models[0].predictions[0].curve.curve.report = {numerics::Termination::interrupted, 0, 0.0,
                                                        "interrupted"};
  result.models[1].predictions.clear();
  const json j = reproduce_json(result);
  EXPECT_EQ(j["series"][0]["models"]["declared"]["stopped"], "interrupted");
  EXPECT_FALSE(j["series"][0]["models"].contains("best_fit"));
  EXPECT_TRUE(j["models"][1]["rmse_N"].is_null());
  EXPECT_TRUE(j["trace"].is_null());
  EXPECT_TRUE(j["leading"].is_null());
}

}  // namespace
}  // namespace snare::app
