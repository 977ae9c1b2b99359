#include "app/report/reproduce_report.hpp"

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace snare::app {
namespace {

using nlohmann::json;

json shape(double displacement) {
  return {{"displacement_mm", displacement},
          {"x_mm", {0.0, 40.0, 175.0}},
          {"y_mm", {0.0, 9.0, 0.0}},
          {"arc_mm", {0.0, 41.0, 180.0}},
          {"tension_N", {5.0, 5.5, 6.0}},
          {"moment_Nm", {0.1, -0.2, 0.1}},
          {"pusher_x_mm", 40.0},
          {"pusher_y_mm", 3.0},
          {"pusher_radius_mm", 6.0}};
}

json computed(double factor) {
  return {{"force_N", {0.0, 0.7 * factor, 2.9 * factor}},
          {"stiffness_N_mm", {0.1 * factor, 1.4 * factor, 2.8 * factor}},
          {"rmse_N", factor - 1.0},
          {"nrmse", (factor - 1.0) / 3.0},
          {"max_N", 2.9 * factor},
          {"shapes", {shape(0.0), shape(2.0)}}};
}

json complete_result() {
  return json::parse(R"({
    "schema": "snare-reproduce/1", "title": "Static push", "source": "somebody, somewhere", "version": "0.1.0",
    "assumptions": ["the range is assumed"],
    "wire": {"diameter_mm": 1.5, "length_mm": 180, "span_mm": 175,
             "bending_stiffness_Nm2": 0.04796, "axial_stiffness_N": 341060},
    "models": [
      {"name": "declared", "label": "declared model", "description": "A solid wire", "free": 0,
       "parameters": {"wire.length_mm": {"value": 180, "stderr": null, "unit": "mm"}}, "rmse_N": 50.0, "nrmse": 17.0},
      {"name": "best_fit", "label": "best fit", "description": "", "free": 1,
       "parameters": {"wire.length_mm": {"value": 175.12345, "stderr": 0.0123, "unit": "mm"}},
       "rmse_N": 0.2, "nrmse": 0.07}],
    "series": [{"name": "s40", "contact_position_mm": 40, "range_mm": 2,
      "published": {"A_N_m2": 719880, "B_N_m": -13.578, "C_N": 0.0533, "R2": 0.9976, "sigma_N": 0.1},
      "displacement_mm": [0, 1, 2], "published_N": [0.05, 0.76, 2.91], "published_stiffness_N_mm": [-0.01, 1.43, 2.87]}]
  })");
}

json result_with_models() {
  json result = complete_result();
  result["series"][0]["models"] = {{"declared", computed(51.0)}, {"best_fit", computed(1.2)}};
  return result;
}

bool contains(const std::string& html, const std::string& part) {
  return html.find(part) != std::string::npos;
}

TEST(ReproduceReport, SaysTheErrorsInWords) {
  const std::string html = reproduce_report_html(result_with_models());
  EXPECT_TRUE(
      contains(html,
               "The declared model with nothing fitted differs from the published force by 50.0 N rms "
               "over all positions, 17.0 times its range and 500 times the published scatter."));
  EXPECT_TRUE(
      contains(html, "The best fit with 1 fitted number differs from the published force by 0.200 N rms"));
  EXPECT_TRUE(contains(html, "7.00 % of its range and 2.0 times the published scatter"));
  EXPECT_TRUE(contains(html, "The published curves are not explained"));
  EXPECT_TRUE(contains(html, "175.123 \u00b1 0.012"));
  EXPECT_TRUE(contains(html, "the range is assumed"));
}

TEST(ReproduceReport, SaysSoWhenTheScatterExplainsTheRest) {
  json result = result_with_models();
  result["models"][1]["rmse_N"] = 0.09;
  EXPECT_TRUE(contains(reproduce_report_html(result),
                       "the best fit agrees with the published curves to within their scatter"));
}

TEST(ReproduceReport, DrawsEveryPlot) {
  const std::string html = reproduce_report_html(result_with_models());
  for (const char* title :
       {"Force at all positions", "Tangent stiffness at all positions", "Force, all models at full scale",
        "Residual: computed minus published force", "Shapes of the wire, declared model",
        "Tension along the wire, best fit", "Bending moment along the wire, best fit"}) {
    EXPECT_TRUE(contains(html, std::string("<span>") + title + "</span>")) << title;
  }
  EXPECT_TRUE(contains(html, "Close-up; beyond it: declared model (to 148 N)."));
}

TEST(ReproduceReport, TellsWhereAModelStopped) {
  json result = result_with_models();
  json& declared = result["series"][0]["models"]["declared"];
  declared["force_N"] = {0.0, 40.0, nullptr};
  declared["stiffness_N_mm"] = json::array();
  declared["shapes"] = json::array();
  declared["stopped"] = "no equilibrium beyond d = 1.2 mm";
  const std::string html = reproduce_report_html(result);
  EXPECT_TRUE(contains(html, "The declared model stopped early: no equilibrium beyond d = 1.2 mm"));
  EXPECT_TRUE(contains(html, "declared model (incomplete)"));
  EXPECT_FALSE(contains(html, "Shapes of the wire, declared model"));
  EXPECT_TRUE(contains(html, "Shapes of the wire, best fit"));
  EXPECT_TRUE(contains(html, "differs from the published force by 50.0 N rms over what was computed"));
}

TEST(ReproduceReport, DoesNotPreferAModelForStoppingEarly) {
  json result = result_with_models();
  result["models"][0]["rmse_N"] = 0.01;
  result["series"][0]["models"]["declared"]["stopped"] = "no equilibrium beyond d = 0.1 mm";
  EXPECT_TRUE(contains(reproduce_report_html(result), "even the best fit stays 2.0 times"));
  result["series"][0]["models"].erase("best_fit");
  EXPECT_TRUE(contains(reproduce_report_html(result), "No verdict"));
}

TEST(ReproduceReport, WorksWithoutAnyOneKey) {
  const json whole = result_with_models().flatten();
  for (const auto& [pointer, value] : whole.items()) {
    json result = result_with_models();
    const json::json_pointer where(pointer);
    if (result[where.parent_pointer()].is_object()) {
      result[where.parent_pointer()].erase(where.back());
    } else {
      result[where] = nullptr;
    }
    EXPECT_NO_THROW(reproduce_report_html(result)) << pointer;
  }
}

TEST(ReproduceReport, WorksWithoutWholeBranches) {
  EXPECT_TRUE(contains(reproduce_report_html(json::object()), "No model was computed."));
  EXPECT_TRUE(contains(reproduce_report_html(complete_result()), "The best fit was not computed here."));
  for (const char* key : {"wire", "models", "series", "assumptions"}) {
    json result = result_with_models();
    result.erase(key);
    EXPECT_NO_THROW(reproduce_report_html(result)) << key;
  }
  for (const char* key :
       {"published", "models", "displacement_mm", "published_N", "published_stiffness_N_mm"}) {
    json result = result_with_models();
    result["series"][0].erase(key);
    EXPECT_NO_THROW(reproduce_report_html(result)) << key;
  }
}

TEST(ReproduceReport, RejectsValuesThatAreNotFinite) {
  json result = result_with_models();
  result["series"][0]["models"]["best_fit"]["force_N"][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(reproduce_report_html(result), std::invalid_argument);
  result = result_with_models();
  result["models"][0]["rmse_N"] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(reproduce_report_html(result), std::invalid_argument);
}

TEST(ReproduceReport, NamesTheKeyOfAWrongType) {
  json result = result_with_models();
  result["models"][0]["rmse_N"] = "large";
  try {
    reproduce_report_html(result);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "rmse_N is string, must be a number");
  }
}

TEST(ReproduceReport, EscapesTheTitle) {
  json result = result_with_models();
  result["title"] = "<script>alert(1)</script>";
  const std::string html = reproduce_report_html(result);
  EXPECT_FALSE(contains(html, "<script>alert"));
  EXPECT_TRUE(contains(html, "<h1>&lt;script&gt;alert(1)&lt;/script&gt;</h1>"));
}

}  // namespace
}  // namespace snare::app
