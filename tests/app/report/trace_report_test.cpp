#include "app/report/trace_report.hpp"

#include "tests/app/report/page_reading.hpp"
#include "tests/app/report/trace_fixture.hpp"

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace snare::app {
namespace {

using identification::Trace;
using nlohmann::json;
using Strings = std::vector<std::string>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string page_of(const Trace& trace) {
  return trace_report_html(traced_experiment(), trace, "0.1.0");
}

TEST(TraceReport, SaysWhatWasFound) {
  const std::string html = page_of(explained_trace());
  expect_all(
      html,
      {"<h1>Push on a wire</h1>",
       ("<p class=\"callout good\">Explained. plasticity: the metal of the wire yields. The error falls "
        "from 0.183 N to 0.162 N.</p>"),
       "348 N rms", "nothing fitted; 2400 times the noise; 29.6 times the force&#39;s range", "0.183 N rms",
       "1 number fitted; 1.2 times the noise", "0.162 N rms", "0.148 N",
       "with plasticity; 1.1 times the noise; 1.4 % of the force&#39;s range",
       "the scatter that the published R\u00b2 implies", "0.301 \u2192 0.205 N",
       "<div class=\"value\">plasticity</div><div class=\"remark\">sits in: wire</div>", "push at s = 30 mm",
       "It separates plasticity and span.", "differ by 1.25 N rms, 8.4 times the noise",
       "Written by snare 0.1.0.", "at most 0.00627 N, 4.2 % of the noise",
       "Computed in 8.5 s: base fit 3.6 s, intervals 4.8 s."});
  EXPECT_FALSE(contains(html, "Where the residual comes from"));
  EXPECT_FALSE(contains(html, "Interrupted"));
}

TEST(TraceReport, SaysWhereTheNoiseIsFrom) {
  Trace trace = explained_trace();
  trace.noise.source = "replicates";
  trace.noise.smooth = 0.25;
  trace.noise.length = 0.012;
  expect_all(page_of(trace),
             {"from the spread of repeated series; 25 % of its variance is smooth, over 12 mm of travel",
              "only the lack of fit counts"});
  trace.noise.smooth = 0.0;
  trace.from_laws = false;
  EXPECT_TRUE(contains(page_of(trace), "<div class=\"remark\">from the spread of repeated series</div>"));
  trace.noise.source = "declared";
  EXPECT_TRUE(contains(page_of(trace), "as declared in the experiment file"));
  trace.noise.source = "residual";
  EXPECT_TRUE(contains(page_of(trace), "from the roughness of the residual"));
}

TEST(TraceReport, NamesEveryCandidateWithItsNumbers) {
  const std::string html = page_of(explained_trace());
  EXPECT_TRUE(contains(html, "Added: plasticity; the refit lowers BIC by 35.86."));
  EXPECT_EQ(row_of(html, {"plasticity", "the metal of the wire yields"}),
            (Strings{"plasticity", "the metal of the wire yields", "wire", "5.76", "2.2e-07", "\u2013"}));
  EXPECT_EQ(row_of(html, {"span", "the distance of the mounts is not as declared"}),
            (Strings{"span", "the distance of the mounts is not as declared", "geometry", "-0.514", "1",
                     "0.0362 mm"}));
  EXPECT_EQ(
      row_of(html, {"plasticity", "0.162"}),
      (Strings{"plasticity", "0.162", "-35.9", "yield stress [MPa]", "182", "145 to 227", "yes", "yes"}));
  EXPECT_EQ(row_of(html, {"span", "0.180"}),
            (Strings{"span", "0.180", "4.20", "span [mm]", "9", "up to 9.5", "no", "\u2013"}));
  EXPECT_TRUE(row_of(html, {"force_gain"}).empty()) << "what these data cannot show has no score";
  expect_all(
      html,
      {"<li>span: mount.span_mm = 9 mm</li>",
       "<li>force_gain (the load cell&#39;s calibration factor is wrong): the fitted numbers change the "
       "curves in the same way</li>",
       "<li>span, force_gain and axial_stiffness; of these the model has axial_stiffness already</li>"});
}

TEST(TraceReport, TellsEveryReasonOnce) {
  Trace trace = explained_trace();
  trace.rounds.push_back(trace.rounds.front());
  const std::string html = page_of(trace);
  const std::string reason = "<li>force_gain (";
  EXPECT_TRUE(contains(html, "Round 2"));
  EXPECT_EQ(html.find(reason), html.rfind(reason));
}

TEST(TraceReport, ShowsTheParametersAndTests) {
  const std::string html = page_of(explained_trace());
  EXPECT_EQ(row_of(html, {"plasticity.yield_stress_MPa"}),
            (Strings{"plasticity.yield_stress_MPa", "MPa", "\u2013", "\u2013", "\u2013", "181.8",
                     "from 147.5", "profile"}));
  EXPECT_EQ(row_of(html, {"wire.axial_stiffness_N"}),
            (Strings{"wire.axial_stiffness_N", "N", "341059", "17216", "16047 to 18471", "27024",
                     "23169 to 31520", "curvature"}));
  EXPECT_EQ(row_of(html, {"Runs, p: does the residual keep its sign longer than by chance?"}),
            (Strings{"Runs, p: does the residual keep its sign longer than by chance?", "0.35", "0.88"}));
  EXPECT_EQ(
      row_of(html, {"Lack of fit, p: is the residual larger than the noise of a reading?"}),
      (Strings{"Lack of fit, p: is the residual larger than the noise of a reading?", "7.9e-06", "0.0099"}));
  EXPECT_TRUE(contains(html, "What the base model leaves is more than noise."));
}

// Law minus model at 0, 1, 2 mm: base 0.0533, -0.0404, 0.2057, rms 0.125; final 0.0533, 0.0596, 0.1057, rms
// 0.0765. Scatter of that law over 3 mm: sqrt(0.0024 / 0.9976 (4 p^2/45 + p q/6 + q^2/12)) = 0.0942, p =
// 6.479, q = -0.0407.
TEST(TraceReport, TellsWhereThePusherStood) {
  Trace trace = explained_trace();
  EXPECT_FALSE(contains(page_of(trace), "Where the pusher stood"));
  trace.places = {{{"s40", "s65"}, 2e-5, -1.5e-5, 4e-6}};
  const std::string html = page_of(trace);
  EXPECT_TRUE(contains(html, "Where the pusher stood"));
  EXPECT_EQ(row_of(html, {"s40 and s65"}), (Strings{"s40 and s65", "0.02", "-0.015", "0.004"}));
}

TEST(TraceReport, ComparesWithThePublishedLaw) {
  const std::string html = page_of(explained_trace());
  const Strings row = row_of(html, {"s40", "0.9976"});
  EXPECT_EQ(row, (Strings{"s40", "0.9976", "0.0942", "173", "0.125", "0.0765"}));
  EXPECT_TRUE(contains(html, "<td class=\"number good\">0.0765</td>")) << "within the scatter";
  EXPECT_TRUE(contains(html, "<td class=\"number \">0.125</td>")) << "beyond it";
  EXPECT_TRUE(contains(html, "The points of s40 are no readings."));
}

TEST(TraceReport, DrawsMeasuredAndModels) {
  const std::string html = page_of(explained_trace());
  const json plot = plot_of(html, "s40, pushed at 40 mm");
  EXPECT_EQ(curve_of(plot, "measured")["x"], json({0.0, 1.0, 2.0})) << "travel in mm";
  EXPECT_EQ(curve_of(plot, "measured")["y"], json({0.1, 0.6, 2.9}));
  EXPECT_EQ(curve_of(plot, "base model")["y"], json({0.0, 0.8, 2.7}));
  EXPECT_EQ(curve_of(plot, "final model")["y"], json({0.0, 0.7, 2.8}));
  EXPECT_EQ(curve_of(plot, "declared model")["y"], json({0.0, 20.0, 301.5}));
  // Measured and fitted reach from 0 to 2.9 N: a tenth more to either side.
  EXPECT_EQ(plot["window"], json({-0.29, 3.19}));
  EXPECT_TRUE(contains(html, "Close-up; the declared model reaches 302 N."));
  const json heldout = plot_of(html, "s65, pushed at 65 mm (held out)");
  EXPECT_EQ(curve_of(heldout, "measured")["y"], json({0.0, 0.5, 2.0}));
  EXPECT_FALSE(heldout.contains("window")) << "the declared model is near: no close-up";
  EXPECT_TRUE(contains(html, "Held out, never shown to a fit: s65."));
}

TEST(TraceReport, ResidualIsMeasuredMinusModel) {
  const std::string html = page_of(explained_trace());
  const json base = plot_of(html, "Measured minus base model, against travel");
  EXPECT_EQ(curve_of(base, "s40")["y"], json({0.1, -0.2, 0.2}));
  EXPECT_EQ(curve_of(base, "s65")["y"], json({0.0, 0.1, 0.1}));
  const json noise = curve_of(base, "noise \u00b1 2 \u03c3");
  EXPECT_EQ(noise["upper"], json({0.296, 0.296})) << "two standard deviations of 0.148 N";
  EXPECT_EQ(noise["lower"], json({-0.296, -0.296}));
  const json final = plot_of(html, "Measured minus final model, against force of the model");
  EXPECT_EQ(curve_of(final, "s40")["x"], json({0.0, 0.7, 2.8}));
  EXPECT_EQ(curve_of(final, "s40")["y"], json({0.1, -0.1, 0.1}));
}

TEST(TraceReport, DrawsResidualsAgainstTimeWhereItWasRecorded) {
  const json plot = plot_of(page_of(explained_trace()), "Measured minus final model, against time");
  EXPECT_EQ(curve_of(plot, "s65")["x"], json({0.0, 5.0, 10.0}));
  EXPECT_EQ(plot["curves"].size(), 2U) << "s65 and the noise: s40 has no times";
  Trace timeless = explained_trace();
  timeless.series[1].readings->time.clear();
  EXPECT_FALSE(contains(page_of(timeless), "against time"));
}

TEST(TraceReport, SaysWhenNothingWasFound) {
  Trace trace = unexplained_trace();
  trace.from_laws = false;
  const std::string html = page_of(trace);
  expect_all(
      html,
      {("<p class=\"callout bad\">Not explained: the catalogue has no effect that brings the error of 0.183 "
        "N down to the noise. No single function of one channel carries over from series to series; the "
        "pusher comes nearest (40 %).</p>"),
       ("<div class=\"value\">not explained</div><div class=\"remark\">not settled by plasticity and "
        "gravity</div>"),
       "the base model, nothing added", "0.500 \u2192 0.700 N", "the effect makes it worse",
       "None carries over well enough", "base model, also final",
       "plasticity and gravity. With them the error would be 0.233 N rms."});
  EXPECT_EQ(row_of(html, {"pusher"}),
            (Strings{"pusher", "the pusher lags behind the travel [mm]", "40 %", "55 %", "no"}));
  EXPECT_EQ(row_of(html, {"wire", "changes the bending stiffness"}),
            (Strings{"wire", "changes the bending stiffness", "&lt; -100 %", "88 %", "no"}));
  EXPECT_TRUE(contains(html, "of force on the pusher [N]: high between 1 and 2"));
  EXPECT_FALSE(contains(html, "Measured minus final model"));
  EXPECT_FALSE(contains(html, "What to measure next"));
}

TEST(TraceReport, DrawsTheFunctionWithItsBand) {
  const json plot = plot_of(page_of(unexplained_trace()), "Function found in the channel: pusher");
  EXPECT_EQ(plot["x"], (json{{"label", "force on the pusher"}, {"unit", "N"}}));
  EXPECT_EQ(plot["y"]["unit"], "mm");
  const json curve = plot["curves"][0];
  EXPECT_EQ(curve["y"], json({0.0, 0.1, 0.4}));
  EXPECT_EQ(curve["lower"], json({-0.02, 0.06, 0.3})) << "two standard deviations below";
  EXPECT_EQ(curve["upper"], json({0.02, 0.14, 0.5}));
  Trace vague = unexplained_trace();
  vague.functions[0].deviation = {10.0, 10.0, 10.0};
  const json close = plot_of(page_of(vague), "Function found in the channel: pusher");
  EXPECT_EQ(close["window"], json({-0.4, 0.8})) << "the function's own size to either side of it";
}

TEST(TraceReport, ListsEffectsThatCannotBeToldApart) {
  Trace trace = explained_trace();
  trace.selected_classes = {{"plasticity", "mount_slip"}};
  trace.decided = false;
  EXPECT_TRUE(contains(page_of(trace), "<div class=\"value\">plasticity or mount slip</div>"));
  trace.alternatives = {unexplained_trace().functions.front()};
  trace.selected_classes = {{"plasticity", "outside:pusher"}};
  const std::string html = page_of(trace);
  expect_all(html, {"plasticity or something in the pusher that the catalogue does not have",
                    "these readings cannot tell which", "Explained, but not decided.",
                    "Causes outside the catalogue that would do as well"});
  EXPECT_EQ(row_of(html, {"pusher"}), (Strings{"pusher", "the pusher lags behind the travel [mm]",
                                               "force on the pusher [N]", "high between 1 and 2", "40 %"}));
}

TEST(TraceReport, SaysWhyAnEffectAloneInItsClassIsNotDecided) {
  Trace trace = explained_trace();
  trace.selected_classes = {{"plasticity"}};
  trace.alternatives.clear();
  trace.decided = false;
  trace.final_tests = {0.88, 0.083, 0.0099, false};  // three together: 3 %
  trace.final_tests.left.upper = 0.1;                // more than the tolerance
  expect_all(page_of(trace),
             {"likely, but not settled", "Noise leaves as much less than once in twenty times"});
  trace.final_tests.lack_of_fit = 0.5;
  expect_all(page_of(trace), {"likely, but not settled", "Conditions left out are not predicted better"});
}

TEST(TraceReport, SaysWhenNothingIsMissing) {
  Trace trace = explained_trace();
  trace.selected.clear();
  trace.significant = false;
  trace.kind = identification::VerdictKind::nothing_missing;
  expect_all(page_of(trace), {"none missing", "no effect is missing.",
                              "What the base model leaves cannot be told from noise."});
}

TEST(TraceReport, SaysWhenWhatMayBeMissingHasNoName) {
  Trace trace = explained_trace();
  trace.selected.clear();
  trace.significant = false;
  trace.kind = identification::VerdictKind::nothing_missing;
  trace.explained = true;
  trace.decided = false;
  trace.from_laws = false;
  trace.tolerance = 1.3;
  trace.peak_force = 130.0;
  trace.base.rmse = 1.2;
  trace.base_tests = {.lack_of_fit = 1e-9, .against_replicates = true, .rmse = 1.2, .noise = 0.4};
  trace.base_tests.left = {.rmse = 1.1, .upper = 1.5, .p = 1e-9};
  trace.remaining = {1.1, 1.5, 1.0, ""};
  expect_all(page_of(trace),
             {"some 1.1 N of it not noise, less than the tolerance of 1.3 N",
              "it may be 1.5 N (1.2 % of the largest force), and no effect of the catalogue lowers",
              "What the base model leaves is not worth a name."});
}

TEST(TraceReport, SaysWhatIsLeftOfAPartialAnswer) {
  Trace trace = explained_trace();
  trace.kind = identification::VerdictKind::partly_explained;
  trace.explained = trace.decided = false;
  trace.peak_force = 10.0;
  trace.remaining = {0.05, 0.1, 0.011, "sensor"};
  expect_all(page_of(trace),
             {"Partly explained. plasticity: the metal of the wire yields.",
              "Left is 0.05 N rms that is not noise, at most 0.1 N (1 % of the largest force), 1.1 % of",
              "it comes nearest to the sensor", "in part; at most 0.100 N rms is left"});
}

TEST(TraceReport, SaysWhatNoSuchWireHas) {
  Trace trace = explained_trace();
  trace.kind = identification::VerdictKind::not_explained;
  trace.explained = trace.decided = false;
  trace.selected.clear();
  trace.findings = {{.key = "wire.axial_stiffness_N", .sure = true}};
  expect_all(page_of(trace), {"with numbers that no such wire has"});
}

// What a run has before its first round: no rounds, no predictions of the final model, no noise yet.
TEST(TraceReport, ShowsWhatAnInterruptedRunKnows) {
  Trace trace = explained_trace();
  trace.interrupted = true;
  trace.explained = false;
  trace.kind = identification::VerdictKind::not_explained;
  trace.selected.clear();
  trace.rounds.clear();
  trace.noise.sigma.clear();
  trace.final_predictions = {};
  trace.declared_predictions.pop_back();
  trace.heldout_rmse.reset();
  trace.left_out_rmse.reset();
  trace.next.reset();
  const std::string html = page_of(trace);
  EXPECT_TRUE(contains(html, "Interrupted: the page shows what was known by then"));
  EXPECT_EQ(curve_of(plot_of(html, "s40, pushed at 40 mm"), "base model, also final")["y"],
            json({0.0, 0.8, 2.7}));
  EXPECT_EQ(plot_of(html, "s65, pushed at 65 mm (held out)")["curves"].size(), 2U)
      << "measured and base model";
  EXPECT_EQ(plot_of(html, "Measured minus base model, against travel")["curves"].size(), 2U)
      << "no noise to draw";
  for (const char* section :
       {"What could be missing", "What to measure next", "Noise of a reading", "Held-out error"}) {
    EXPECT_FALSE(contains(html, section)) << section;
  }
}

TEST(TraceReport, ShowsWhatIsNotKnownAsADash) {
  Trace trace = explained_trace();
  trace.declared.rmse = trace.declared.nrmse = trace.final.chi2_dof = nan;
  trace.mesh_error = nan;
  trace.final_tests.runs = nan;
  trace.final.numbers[0].value = nan;
  trace.rounds[0].candidates[0].score.z = nan;
  trace.rounds[0].candidates[0].delta_bic = nan;
  trace.heldout_rmse = {nan, nan};
  const std::string html = own_part(page_of(trace));
  EXPECT_FALSE(contains(html, "nan") || contains(html, "NaN"));
  expect_all(html, {"<div class=\"label\">Error as declared</div><div class=\"value\">\u2013</div>",
                    "0.500 \u2192 0.700 N"});
  EXPECT_EQ(row_of(html, {"Runs, p: does the residual keep its sign longer than by chance?"}).back(),
            "\u2013");
  EXPECT_EQ(row_of(html, {"wire.axial_stiffness_N"})[5], "\u2013");
  EXPECT_EQ(row_of(html, {"plasticity", "0.162"})[2], "\u2013");
  EXPECT_FALSE(contains(html, "Dividing the wire into finite pieces"));
}

TEST(TraceReport, NamesPlotAndCurveOfAValueThatIsNotFinite) {
  Trace trace = explained_trace();
  std::vector<identification::Prediction> predictions = trace.final_predictions;
  predictions[0].force[1] = nan;
  trace.final_predictions = predictions;
  try {
    page_of(trace);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "plot 's40, pushed at 40 mm', curve 'final model': y[1] = nan, must be finite");
  }
}

TEST(TraceReport, EscapesTheTitle) {
  identification::Experiment experiment = traced_experiment();
  experiment.title = "<script>alert(1)</script>";
  const std::string html = trace_report_html(experiment, explained_trace(), "0.1.0");
  EXPECT_FALSE(contains(html, "<script>alert"));
  EXPECT_TRUE(contains(html, "<h1>&lt;script&gt;alert(1)&lt;/script&gt;</h1>"));
}

}  // namespace
}  // namespace snare::app
