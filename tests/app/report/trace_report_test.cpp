#include "app/report/trace_report.hpp"

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace snare::app {
namespace {

using nlohmann::json;

json explained() {
  return json::parse(R"({
    "schema": "snare-trace/1", "title": "Push on a wire", "source": "somebody, somewhere", "version": "0.1.0",
    "verdict": "Explained. plasticity: the metal of the wire yields.", "interrupted": false,
    "noise": {"sigma_N": 0.148, "source": "declared", "smooth_share": 0.0, "correlation_length_mm": 0.0,
              "drawn_about_published_laws": true},
    "declared": {"rmse_N": 348.4, "nrmse": 29.6, "chi2_dof": 6107038.0, "parameters": {}},
    "base": {"rmse_N": 0.1826, "nrmse": 0.0155, "chi2_dof": 1.668, "parameters": {
      "wire.axial_stiffness_N": {"value": 17216.4, "stderr": 617.0, "declared": 341059.0, "unit": "N",
                                 "lower95": 16047.2, "upper95": 18470.9, "profiled": false}}},
    "final": {"rmse_N": 0.1622, "nrmse": 0.0138, "chi2_dof": 1.331, "parameters": {
      "plasticity.yield_stress_MPa": {"value": 181.8, "stderr": 20.0, "declared": null, "unit": "MPa",
                                      "lower95": 147.5, "upper95": null, "profiled": true},
      "wire.axial_stiffness_N": {"value": 27023.7, "stderr": 2122.0, "declared": 341059.0, "unit": "N",
                                 "lower95": 23168.6, "upper95": 31520.3, "profiled": false}}},
    "residual": {"significant": true,
                 "tests": {"runs_p": 0.35, "ljung_box_p": 0.071, "lack_of_fit_p": 7.9e-06},
                 "tests_after": {"runs_p": 0.88, "ljung_box_p": 0.083, "lack_of_fit_p": 0.0099}},
    "rounds": [{"added": "plasticity", "reason": "the refit lowers BIC by 35.86",
      "classes": [["plasticity"], ["span", "force_gain", "axial_stiffness"]],
      "candidates": [
        {"effect": "plasticity", "channel": "wire", "meaning": "the metal of the wire yields", "observable": true,
         "why_unobservable": null, "score_z": 5.758, "score_p": 1.7e-08, "score_p_holm": 2.2e-07, "refitted": true,
         "rmse_N": 0.1621, "delta_bic": -35.86, "value": {"plasticity.yield_stress_MPa": 181.8},
         "interval95": {"plasticity.yield_stress_MPa": [145.4, 227.2]}, "plausible": true, "why_implausible": null,
         "heldout_improves": true, "detectable": {"key": "plasticity.yield_stress_MPa", "size": null}, "class": 0},
        {"effect": "span", "channel": "geometry", "meaning": "the distance of the mounts is not as declared",
         "observable": true, "score_z": -0.5143, "score_p_holm": 1.0, "refitted": true, "rmse_N": 0.18,
         "delta_bic": 4.2, "value": {"mount.span_mm": 9.0}, "interval95": {"mount.span_mm": [null, 9.5]},
         "plausible": false, "why_implausible": "mount.span_mm = 9 mm", "heldout_improves": null,
         "detectable": {"key": "mount.span_mm", "size": 0.0362}, "class": 1},
        {"effect": "force_gain", "channel": "sensor", "meaning": "the load cell's calibration factor is wrong",
         "observable": false, "why_unobservable": "the fitted numbers change the curves in the same way",
         "score_z": 0.0, "score_p_holm": 1.0, "refitted": false, "rmse_N": null, "delta_bic": null, "value": {},
         "interval95": {}, "plausible": true, "detectable": {"key": "reading.force_gain", "size": null}, "class": 1}]}],
    "selected": ["plasticity"], "selected_classes": [["plasticity"]],
    "partial": {"effects": [], "rival_explanation": false, "rmse_N": null},
    "heldout": {"rmse_base_N": 0.301, "rmse_final_N": 0.205}, "left_out": {"rmse_base_N": 0.5, "rmse_final_N": 0.7},
    "explained": true, "channel": "wire", "functions": [], "mesh_error_N": 0.00627,
    "seconds": {"base fit": 3.65, "intervals": 4.81, "reading": 1e-05},
    "next_experiment": {"what": "push at s = 30 mm", "separates": ["plasticity", "span"], "difference_N": 1.25,
                        "difference_sigma": 8.4},
    "series": [
      {"name": "s40", "contact_position_mm": 40.0, "span_mm": 175.0, "heldout": false, "drawn": true,
       "displacement_mm": [0, 1, 2], "measured_N": [0.1, 0.6, 2.9], "time_s": [], "declared_N": [0, 20, 301.5],
       "base_N": [0, 0.8, 2.7], "final_N": [0, 0.7, 2.8],
       "law": {"A_N_m2": 719880.0, "B_N_m": -13.6, "C_N": 0.053, "R2": 0.9976, "scatter_N": 0.1677,
               "declared_rmse_N": 11.7, "base_rmse_N": 0.2022, "final_rmse_N": 0.0801}},
      {"name": "s65", "contact_position_mm": 65.0, "heldout": true, "drawn": false, "displacement_mm": [0, 1, 2],
       "measured_N": [0.0, 0.5, 2.0], "time_s": [0, 5, 10], "declared_N": [0, 0.6, 2.1], "base_N": [0, 0.4, 1.9],
       "final_N": [0, 0.5, 1.95]}]
  })");
}

json unexplained() {
  json result = explained();
  result["explained"] = false;
  result["verdict"] = "Not explained: the catalogue has no effect for it.";
  result["selected"] = json::array();
  result["selected_classes"] = json::array();
  result["final"] = result["base"];
  result["next_experiment"] = {{"what", ""}, {"separates", json::array()}};
  result["heldout"] = {{"rmse_base_N", nullptr}, {"rmse_final_N", nullptr}};
  result["partial"] = {{"effects", {"plasticity", "gravity"}}, {"rival_explanation", false}, {"rmse_N", 0.233}};
  for (json& series : result["series"]) series["final_N"] = series["base_N"];
  result["functions"] = json::parse(R"([
    {"channel": "pusher", "argument": "force on the pusher [N]", "effect": "the pusher lags behind the travel [mm]",
     "at": [0, 1, 2], "value": [0.0, 0.1, 0.4], "deviation": [0.01, 0.02, 0.05], "carried_over": 0.4,
     "explained": 0.55, "chi2_dof": 2.1, "accepted": false, "shape": "high between 1 and 2"},
    {"channel": "wire", "argument": "place along the wire [mm]", "effect": "changes the bending stiffness",
     "at": [0, 1], "value": [0, 0], "deviation": [1, 1], "carried_over": -43.1, "explained": 0.88,
     "chi2_dof": 1.1, "accepted": false, "shape": "nowhere beyond three standard deviations"}])");
  return result;
}

bool contains(const std::string& html, const std::string& part) {
  return html.find(part) != std::string::npos;
}

/// The page without the plot library, whose source has words such as NaN.
std::string own_part(const std::string& html) {
  return html.substr(0, html.find("</footer>"));
}

void expect_all(const std::string& html, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_TRUE(contains(html, part)) << part;
}

TEST(TraceReport, SaysWhatWasFound) {
  const std::string html = trace_report_html(explained());
  expect_all(html, {"<h1>Push on a wire</h1>",
                    "<p class=\"callout good\">Explained. plasticity: the metal of the wire yields.</p>",
                    "348 N rms", "0.183 N rms", "0.162 N rms", "0.148 N",
                    "with plasticity; 1.1 times the noise; 1.4 % of the force&#39;s range",
                    "the scatter that the published R\u00b2 implies", "0.301 \u2192 0.205 N",
                    "push at s = 30 mm", "It separates plasticity and span.",
                    "differ by 1.25 N rms, 8.4 times the noise", "Written by snare 0.1.0.",
                    "at most 0.00627 N, 4.2 % of the noise", "Computed in 8.5 s: base fit 3.6 s, intervals 4.8 s."});
  EXPECT_FALSE(contains(html, "Where the residual comes from"));
  EXPECT_FALSE(contains(html, "Interrupted"));
}

TEST(TraceReport, NamesEveryCandidateWithItsNumbers) {
  const std::string html = trace_report_html(explained());
  expect_all(html, {"Added: plasticity; the refit lowers BIC by 35.86.",
                    "<code>plasticity</code>", "<code>span</code>", "the distance of the mounts is not as declared",
                    "5.76", "2.2e-07", "-35.9", "yield stress [MPa]", "145 to 227", "up to 9.5<", "0.0362 mm",
                    "<li>span: mount.span_mm = 9 mm</li>",
                    "<li>force_gain (the load cell&#39;s calibration factor is wrong): the fitted numbers change the "
                    "curves in the same way</li>",
                    "<li>span, force_gain and axial_stiffness; of these the model has axial_stiffness already</li>"});
}

TEST(TraceReport, ShowsTheParametersAndTests) {
  const std::string html = trace_report_html(explained());
  expect_all(html, {"<code>plasticity.yield_stress_MPa</code>", "from 147.5", "profile", "341059", "16047 to 18471",
                    "23169 to 31520", "curvature", "0.35", "0.88", "7.9e-06", "0.0099", "1.7", "1.3", "0.9976"});
}

TEST(TraceReport, DrawsEveryPlot) {
  const std::string html = trace_report_html(explained());
  expect_all(html, {"<span>s40, pushed at 40 mm</span>", "<span>s65, pushed at 65 mm (held out)</span>",
                    "Close-up; the declared model reaches 302 N.", "<span>Measured minus base model, against travel</span>",
                    "<span>Measured minus final model, against force of the model</span>",
                    "<span>Measured minus final model, against time</span>", "Held out, never shown to a fit: s65.",
                    "The points of s40 are no readings."});
  json timeless = explained();
  for (json& series : timeless["series"]) series["time_s"] = json::array();
  EXPECT_FALSE(contains(trace_report_html(timeless), "against time"));
}

// The first reading is 0.1 N where the base model gives 0.
TEST(TraceReport, ResidualIsMeasuredMinusModel) {
  const std::string html = trace_report_html(explained());
  EXPECT_TRUE(contains(html, "[0.1,-0.2,0.2]"));
  EXPECT_TRUE(contains(html, "[0.1,-0.1,0.1]"));
}

TEST(TraceReport, SaysWhenNothingWasFound) {
  const std::string html = trace_report_html(unexplained());
  expect_all(html, {"<p class=\"callout bad\">Not explained: the catalogue has no effect for it.</p>", "not explained",
                    "the base model, nothing added", "0.500 \u2192 0.700 N", "Where the residual comes from",
                    "40 %", "55 %", "&lt; -100 %", "high between 1 and 2", "None carries over well enough",
                    "<span>Function found in the channel: pusher</span>",
                    "plasticity and gravity. With them the error would be 0.233 N rms.", "base model, also final"});
  EXPECT_FALSE(contains(html, "Measured minus final model"));
  EXPECT_FALSE(contains(html, "What to measure next"));
}

TEST(TraceReport, ListsEffectsThatCannotBeToldApart) {
  json result = explained();
  result["selected_classes"] = json::array({json::array({"plasticity", "mount_slip"})});
  EXPECT_TRUE(contains(trace_report_html(result), "<div class=\"value\">plasticity or mount slip</div>"));
}

TEST(TraceReport, SaysWhenNothingIsMissingAndWhenInterrupted) {
  json result = explained();
  result["selected"] = json::array();
  EXPECT_TRUE(contains(trace_report_html(result), "none missing"));
  result["interrupted"] = true;
  EXPECT_TRUE(contains(trace_report_html(result), "Interrupted: the page shows what was known by then"));
}

TEST(TraceReport, WorksForAnEmptyResult) {
  const std::string html = trace_report_html(json::object());
  EXPECT_TRUE(contains(html, "<h1>What the model lacks</h1>"));
  EXPECT_TRUE(contains(html, "No model was traced."));
  for (const char* section : {"Before and after", "Residuals", "What could be missing", "The model now"}) {
    EXPECT_FALSE(contains(html, section)) << section;
  }
}

TEST(TraceReport, WorksWithoutAnyOneKey) {
  for (const json& whole : {explained(), unexplained()}) {
    const json flat = whole.flatten();
    for (const auto& [pointer, value] : flat.items()) {
      const json::json_pointer where(pointer);
      json result = whole;
      result[where] = nullptr;
      std::string html;
      EXPECT_NO_THROW(html = own_part(trace_report_html(result))) << pointer;
      EXPECT_FALSE(contains(html, "nan") || contains(html, "NaN") || contains(html, "inf,")) << pointer;
    }
    for (const auto& [key, value] : whole.items()) {
      json result = whole;
      result.erase(key);
      EXPECT_NO_THROW(trace_report_html(result)) << key;
    }
  }
}

TEST(TraceReport, NamesTheKeyOfAWrongType) {
  const std::vector<std::pair<const char*, const char*>> keys = {
      {"/final/rmse_N", "rmse_N"},          {"/noise", "noise"},
      {"/explained", "explained"},          {"/series/0/measured_N", "measured_N"},
      {"/rounds/0", "rounds"},              {"/rounds/0/candidates/0/interval95/plasticity.yield_stress_MPa/0",
                                             "plasticity.yield_stress_MPa"},
      {"/rounds/0/classes/0", "classes"},   {"/seconds/intervals", "intervals"},
      {"/next_experiment", "next_experiment"}};
  for (const auto& [pointer, key] : keys) {
    json result = explained();
    result[json::json_pointer(pointer)] = "large";
    try {
      trace_report_html(result);
      ADD_FAILURE() << "accepted " << pointer;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind(std::string(key) + " is string, must be ", 0), 0U) << error.what();
    }
  }
}

TEST(TraceReport, NamesTheKeyOfAValueThatIsNotFinite) {
  json result = explained();
  result["series"][0]["final_N"][1] = std::numeric_limits<double>::quiet_NaN();
  try {
    trace_report_html(result);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "final_N = nan, must be finite");
  }
  result = explained();
  result["mesh_error_N"] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(trace_report_html(result), std::invalid_argument);
}

TEST(TraceReport, EscapesTheTitle) {
  json result = explained();
  result["title"] = "<script>alert(1)</script>";
  const std::string html = trace_report_html(result);
  EXPECT_FALSE(contains(html, "<script>alert"));
  EXPECT_TRUE(contains(html, "<h1>&lt;script&gt;alert(1)&lt;/script&gt;</h1>"));
}

}  // namespace
}  // namespace snare::app
