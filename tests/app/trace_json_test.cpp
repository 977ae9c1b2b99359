#include "results/trace_json.hpp"

#include "tests/app/report/trace_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace snare::app {

using namespace results;

namespace {

using nlohmann::json;

TEST(TraceJson, HasTheNumbersOfTheTrace) {
  const json t = trace_json(traced_experiment(), explained_trace());
  EXPECT_EQ(t["noise"]["sigma_N"], 0.148);
  EXPECT_EQ(t["base"]["rmse_N"], 0.1826);
  EXPECT_EQ(t["final"]["parameters"]["plasticity.yield_stress_MPa"]["lower95"], 147.5);
  EXPECT_EQ(t["rounds"][0]["candidates"][1]["effect"], "span");
  EXPECT_EQ(t["rounds"][0]["candidates"][1]["interval95"]["mount.span_mm"], json({nullptr, 9.5}));
  EXPECT_EQ(t["candidates"], t["rounds"][0]["candidates"]);
  EXPECT_EQ(t["heldout"], (json{{"rmse_base_N", 0.301}, {"rmse_final_N", 0.205}}));
  EXPECT_EQ(t["series"][0]["displacement_mm"], json({0.0, 1.0, 2.0}));
  EXPECT_EQ(t["series"][0]["final_N"], json({0.0, 0.7, 2.8}));
  // Law minus final model at 0, 1, 2 mm: 0.0533, 0.059602, 0.105664.
  EXPECT_NEAR(t["series"][0]["law"]["final_rmse_N"].get<double>(), 0.0765, 5e-5)
      << "last digit of the number above";
  EXPECT_FALSE(t["series"][1].contains("law"));
  EXPECT_EQ(t["decided"], true);
  EXPECT_EQ(t["verdict_kind"], "explained");
  EXPECT_TRUE(t["remaining"].contains("rmse_N"));
  EXPECT_EQ(t["next_experiment"]["difference_sigma"], 8.4);
}

TEST(TraceJson, TellsWhereThePusherStood) {
  identification::Trace trace = explained_trace();
  EXPECT_EQ(trace_json(traced_experiment(), trace)["places"], json::array());
  trace.places = {{{"s40", "s40b"}, 2e-5, -1.5e-5, 4e-6}};
  const json places = trace_json(traced_experiment(), trace)["places"];
  EXPECT_EQ(
      places,
      json::array(
          {{{"series", {"s40", "s40b"}}, {"sigma_mm", 0.02}, {"shift_mm", -0.015}, {"stderr_mm", 0.004}}}));
}

TEST(TraceJson, WritesNullForWhatIsNotKnown) {
  identification::Trace trace = explained_trace();
  trace.noise.sigma.clear();
  trace.final.rmse = std::nan("");
  trace.final_predictions = {};
  trace.heldout_rmse.reset();
  trace.next.reset();
  const json t = trace_json(traced_experiment(), trace);
  EXPECT_TRUE(t["noise"]["sigma_N"].is_null());
  EXPECT_TRUE(t["final"]["rmse_N"].is_null());
  EXPECT_TRUE(t["final"]["parameters"]["plasticity.yield_stress_MPa"]["declared"].is_null());
  EXPECT_TRUE(t["heldout"]["rmse_base_N"].is_null());
  EXPECT_TRUE(t["series"][0]["law"]["final_rmse_N"].is_null());
  EXPECT_EQ(t["series"][0]["final_N"], json::array());
  EXPECT_EQ(t["next_experiment"], (json{{"what", ""}, {"separates", json::array()}}));
}

}  // namespace
}  // namespace snare::app
