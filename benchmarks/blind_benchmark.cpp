// How often the tracing names the right class: blind sets of the continuous wire with an effect that the
// declared model lacks, every effect, several seeds and sizes. Prints one line a set and writes the confusion
// matrix as JSON.
//   blind_benchmark [--seeds N] [--first SEED] [--sizes 5,10,30] [--effects a,b] [--design NAME]
//     [--intervals]
//   [--minutes M] [--out FILE] [--sets FILE] [--require]
// --effects a+b puts two in at once; --pairs takes a list of such pairs.
// --sets keeps every set's outcome, one line of JSON each; a run that finds the file continues where it
// ended. It belongs to one build: another one starts with a new file. --minutes ends a run after a set.
// --design geometry: length off by 0.1 mm and freed, every position off by 0.02 mm (standard deviations);
// replicates and
// dense: three pushes, three records each that deviate smoothly, noise not declared, 20 and 40 readings a leg
// of the same wire and noise. Shares come with the lower end of their one-sided 95 % interval (Clopper and
// Pearson 1934), rates of errors with the upper.

#include "base/files.hpp"
#include "identification/tracing/trace.hpp"
#include "validation/blind_set.hpp"
#include "validation/trace_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <CLI/CLI.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <mutex>

using namespace snare;

namespace {

struct Case {
  std::string effect;
  double size = 0.0;
  unsigned seed = 0;
  std::string design = "plain";
};

validation::BlindDesign design_of(const std::string& name) {
  validation::BlindDesign design;
  if (name == "geometry") design = {.length_deviation = 1e-4, .position_deviation = 2e-5};
  if (name == "replicates") design.replicates = 3;
  if (name == "dense") design = {.readings_a_leg = 40, .replicates = 3};
  return design;
}

/// Where the chance of at least `k` of n, or of at most `k`, is 5 %: bounds of a share that was seen as k of
/// n.
double lower_bound(double k, double n) {
  return k <= 0.0 ? 0.0 : boost::math::binomial_distribution<>::find_lower_bound_on_p(n, k, 0.05);
}
double upper_bound(double k, double n) {
  return k >= n ? 1.0 : boost::math::binomial_distribution<>::find_upper_bound_on_p(n, k, 0.05);
}

struct Outcome {
  bool right = false;    // the class holds the effect (nothing, where nothing is inside); see judge()
  bool alarm = false;    // an effect was selected
  bool channel = false;  // of an effect that is in no catalogue
  // The class of the selected effect holds a cause outside the catalogue (the right one, if one is inside).
  bool alternative = false;
  int covered = 0;               // base numbers within their intervals, of two
  int effect_covered = -1;       // the effect's number within its interval; -1: not asked
  std::vector<double> deviates;  // of the base numbers from the truth, in standard errors
  double chi2_dof = 0.0;
  double left_out = 0.0;  // error of series predicted from the others, over the noise
  std::string answer;
  double class_size = 0.0;
  double mechanisms = 0.0;  // likewise, slips of either kind and end counted as one
  double seconds = 0.0;
  double made_size = 0.0;
  bool decided = false;
  // of several effects some are named and none that is not inside, or none at all as unexplained
  bool partial = false;
  double probability = 0.0;  // of the hypotheses that hold what is inside; 0 without hypotheses
  std::string leading;       // hypothesis, with its variable where an unknown function leads
  // probabilities from 0.01 to 0.99, and which are of what is inside
  std::vector<std::pair<double, bool>> weighed;
  bool finished = false;
  bool reached = true;  // the effect could be made that large (weight cannot)
};

bool is_slip(const std::string& effect) {
  return effect.starts_with("mount_slip") || effect.starts_with("clamp_slide");
}

/// What the hypotheses say of what is inside: effects, an unknown function of the right variable, or nothing.
void weigh(const validation::BlindSet& set, const identification::Trace& t, Outcome& o) {
  const std::vector<std::string> inside = validation::effects_in(set.effect);
  const std::map<std::string, std::string> outside{{"damage", "place"}};
  for (const identification::CauseHypothesis& h : t.hypotheses) {
    bool right = std::ranges::is_permutation(h.effects, inside) && h.discrepancy.empty();
    if (set.effect == "none") right = h.effects.empty() && h.discrepancy.empty();
    if (const auto at = outside.find(set.effect); at != outside.end())
      right = h.effects.empty() && h.discrepancy == at->second;
    if (right) o.probability += h.probability;
    if (h.probability >= 0.01 && h.probability <= 0.99) o.weighed.emplace_back(h.probability, right);
  }
  if (t.hypotheses.empty()) return;
  const identification::CauseHypothesis& first = t.hypotheses.front();
  o.leading = fmt::format("{}{}{}", fmt::join(first.effects, "+"), first.discrepancy.empty() ? "" : "~",
                          first.discrepancy);
}

Outcome judge(const validation::BlindSet& set, const identification::Trace& t) {
  Outcome o;
  weigh(set, t, o);
  o.alarm = !t.selected.empty();
  o.decided = t.decided;
  o.made_size = set.size;
  o.chi2_dof = t.final.chi2_dof;
  o.alternative = !t.selected.empty() && !t.alternatives.empty();
  for (const std::vector<std::string>& members : t.selected_classes) {
    const auto slips = static_cast<std::size_t>(std::ranges::count_if(members, is_slip));
    const auto classes = static_cast<double>(t.selected_classes.size());
    o.class_size += static_cast<double>(members.size()) / classes;
    o.mechanisms += static_cast<double>(members.size() - slips + std::min<std::size_t>(slips, 1)) / classes;
    o.right = o.right || std::find(members.begin(), members.end(), set.effect) != members.end();
  }
  const std::vector<std::string> inside = validation::effects_in(set.effect);
  if (inside.size() > 1) {
    std::size_t named = 0;
    for (const std::string& one : inside) {
      named += std::ranges::any_of(t.selected_classes, [&](const std::vector<std::string>& members) {
        return std::ranges::find(members, one) != members.end();
      });
    }
    const bool nothing_else = named >= t.selected.size();
    o.right = named == inside.size() && nothing_else;
    o.partial = !o.right && nothing_else && (!t.explained || !t.selected.empty());
    o.answer = t.selected.empty() ? to_string(t.kind) : fmt::format("{}", fmt::join(t.selected, "+"));
    return o;
  }
  // One effect was inside: a second one is an error.
  if (t.selected.size() > 1) o.right = false;
  // The numbers of the base model may take up an effect whole: then nothing else is to be named.
  if (!t.rounds.empty()) {
    for (const identification::Candidate& c : t.rounds.front().candidates) {
      if (c.score.effect->name == set.effect && c.score.absorbed && t.selected.empty() && t.explained)
        o.right = true;
    }
  }
  if (set.effect == "none") o.right = t.selected.empty() && t.explained;
  const bool outside = set.effect == "damage" || set.effect == "drift";
  if (outside) {
    o.right = validation::is_right_outside(set, t);
    const std::string where = set.effect == "damage" ? "wire" : "sensor";
    o.channel = o.right && t.channel == where;
    const std::string member = "outside:" + where;
    o.alternative = !t.selected.empty() &&
                    std::ranges::find(t.selected_classes.front(), member) != t.selected_classes.front().end();
  }
  o.answer = t.selected.empty() ? (t.explained ? "nothing" : "unexplained:" + t.channel)
                                : fmt::format("{}", fmt::join(t.selected, "+"));
  if (t.left_out_rmse) o.left_out = t.left_out_rmse->second / t.noise.sigma.front();
  for (const identification::FittedNumber& n : t.final.numbers) {
    const double truth = n.key == "wire.bending_stiffness_Nm2" ? set.bending_stiffness
                         : n.key == "wire.axial_stiffness_N"   ? set.axial_stiffness
                                                               : std::nan("");
    if (n.lower && n.upper && *n.lower <= truth && truth <= *n.upper) ++o.covered;
    if (n.profiled && n.key == set.key && o.right) {
      o.effect_covered = (!n.lower || *n.lower <= set.truth) && (!n.upper || set.truth <= *n.upper) ? 1 : 0;
    }
    if (n.standard_error && std::isfinite(truth)) o.deviates.push_back((n.value - truth) / *n.standard_error);
  }
  return o;
}

nlohmann::json line_of(const Case& c, const Outcome& o) {
  return {{"effect", c.effect},
          {"size", c.size},
          {"seed", c.seed},
          {"right", o.right},
          {"alarm", o.alarm},
          {"channel", o.channel},
          {"beside", o.alternative},
          {"deviates", o.deviates},
          {"covered", o.covered},
          {"chi2_dof", o.chi2_dof},
          {"left_out", o.left_out},
          {"answer", o.answer},
          {"class", o.class_size},
          {"mechanisms", o.mechanisms},
          {"decided", o.decided},
          {"seconds", o.seconds},
          {"made", o.made_size},
          {"reached", o.reached},
          {"partial", o.partial},
          {"design", c.design},
          {"probability", o.probability},
          {"leading", o.leading},
          {"weighed", o.weighed},
          {"effect_covered", o.effect_covered}};
}

Outcome outcome_of(const nlohmann::json& line) {
  Outcome o;
  o.right = line["right"];
  o.alarm = line["alarm"];
  o.channel = line["channel"];
  o.alternative = line["beside"];
  o.deviates = line["deviates"].get<std::vector<double>>();
  o.covered = line["covered"];
  o.chi2_dof = line["chi2_dof"];
  o.left_out = line["left_out"];
  o.answer = line["answer"];
  o.class_size = line["class"];
  o.mechanisms = line.value("mechanisms", o.class_size);
  o.decided = line.value("decided", false);
  o.seconds = line["seconds"];
  o.made_size = line["made"];
  o.reached = line["reached"];
  o.partial = line.value("partial", false);
  o.effect_covered = line.value("effect_covered", -1);
  o.probability = line.value("probability", 0.0);
  o.leading = line.value("leading", "");
  o.weighed = line.value("weighed", o.weighed);
  o.finished = true;
  return o;
}

/// Outcomes of an earlier run, as far as they are whole lines; one a case.
std::vector<Outcome> read_sets(const std::string& file, const std::vector<Case>& cases) {
  std::vector<Outcome> outcomes(cases.size());
  std::ifstream in(file);
  for (std::string text; std::getline(in, text);) {
    const nlohmann::json line = nlohmann::json::parse(text, nullptr, false);
    if (line.is_discarded()) continue;
    const auto at = std::find_if(cases.begin(), cases.end(), [&line](const Case& c) {
      return c.effect == line["effect"] && c.size == line["size"] && c.seed == line["seed"] &&
             c.design == line.value("design", "plain");
    });
    if (at != cases.end()) outcomes[static_cast<std::size_t>(at - cases.begin())] = outcome_of(line);
  }
  return outcomes;
}

/// Counts of one size.
struct Totals {
  double inside = 0, right = 0, class_size = 0, mechanisms = 0, undecided = 0, numbers = 0, covered = 0,
         at_noise = 0, left_out = 0;
  double decided = 0, decided_right = 0;  // effects that were named, of causes inside and outside
  double outside = 0, silent = 0, channel = 0, named = 0;
  double pairs = 0, both = 0, part = 0, asked = 0, effect_covered = 0;
};

/// Counts over the sets that are finished.
nlohmann::json summary(const std::vector<Case>& cases, const std::vector<Outcome>& outcomes) {
  nlohmann::json result{{"schema", "snare-blind/1"},
                        {"matrix", nlohmann::json::object()},
                        {"not_reached", nlohmann::json::object()}};
  std::map<double, Totals> totals;
  double quiet = 0.0, nothing = 0.0, seconds = 0.0, finished = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    const Outcome& o = outcomes[i];
    if (!o.finished) continue;
    finished += 1.0;
    seconds += o.seconds;
    if (!o.reached) {
      result["not_reached"][c.effect] = result["not_reached"].value(c.effect, 0) + 1;
      continue;
    }
    nlohmann::json& cell = result["matrix"][c.effect][fmt::format("{:g}", c.size)];
    if (cell.is_null())
      cell = {{"right", 0}, {"sets", 0}, {"mean_class_size", 0.0}, {"answers", nlohmann::json::object()}};
    const double before = cell["sets"];
    cell["mean_class_size"] =
        (before * cell["mean_class_size"].get<double>() + o.class_size) / (before + 1.0);
    cell["right"] = cell.value("right", 0) + (o.right ? 1 : 0);
    cell["sets"] = cell.value("sets", 0) + 1;
    cell["answers"][o.answer] = cell["answers"].value(o.answer, 0) + 1;
    // A gain scales the forces as EI and EA do: no reading shows it, such a set is one without effect.
    if (c.effect == "none" || c.effect == "force_gain") {
      nothing += 1.0;
      quiet += o.alarm ? 0.0 : 1.0;
      continue;
    }
    Totals& t = totals[c.size];
    if (o.alarm && o.decided) {
      ++t.decided;
      t.decided_right += o.right ? 1 : 0;
    }
    if (c.effect.find('+') != std::string::npos) {
      ++t.pairs;
      t.both += o.right ? 1 : 0;
      t.part += o.partial ? 1 : 0;
      continue;
    }
    if (c.effect == "damage" || c.effect == "drift") {
      ++t.outside;
      t.silent += o.alarm ? 0 : 1;
      t.channel += o.channel ? 1 : 0;
      t.named += o.channel || o.alternative ? 1 : 0;
      continue;
    }
    ++t.inside;
    t.right += o.right ? 1 : 0;
    if (o.effect_covered >= 0) {
      ++t.asked;
      t.effect_covered += o.effect_covered;
    }
    t.class_size += o.class_size;
    t.mechanisms += o.mechanisms;
    t.undecided += o.alternative ? 1 : 0;
    t.numbers += 2;
    t.covered += o.covered;
    t.at_noise += o.chi2_dof > 0.8 && o.chi2_dof < 1.2 ? 1 : 0;
    t.left_out += o.left_out;
  }
  result["sets_finished"] = finished;
  result["sets_asked"] = cases.size();
  result["false_alarms"] = nothing > 0.0 ? 1.0 - quiet / nothing : 0.0;
  result["false_alarms_at_most"] = nothing > 0.0 ? upper_bound(nothing - quiet, nothing) : 1.0;
  result["sets_without_effect"] = nothing;
  result["mean_seconds_a_trace"] = seconds / std::max(1.0, finished);
  for (const auto& [size, t] : totals) {
    nlohmann::json& s = result["sizes"][fmt::format("{:g}", size)];
    if (t.inside > 0) {
      s["sets"] = t.inside;
      s["right_class"] = t.right / t.inside;
      s["right_class_at_least"] = lower_bound(t.right, t.inside);
      s["mean_class_size"] = t.class_size / t.inside;
      s["mean_class_size_slips_as_one"] = t.mechanisms / t.inside;
      s["class_holds_a_cause_outside"] = t.undecided / t.inside;
      s["chi2_dof_within_0.8_and_1.2"] = t.at_noise / t.inside;
      s["mean_error_of_left_out_series_over_noise"] = t.left_out / t.inside;
      if (t.numbers > 0) s["base_numbers_covered"] = t.covered / t.numbers;
      if (t.asked > 0) {
        s["effects_numbers"] = t.asked;
        s["effects_numbers_covered"] = t.effect_covered / t.asked;
        s["effects_numbers_covered_at_least"] = lower_bound(t.effect_covered, t.asked);
      }
    }
    if (t.decided > 0) {
      s["decided"] = t.decided;
      s["decided_right"] = t.decided_right / t.decided;
      s["decided_right_at_least"] = lower_bound(t.decided_right, t.decided);
    }
    if (t.pairs > 0) {
      s["pairs"] = t.pairs;
      s["pairs_both_named"] = t.both / t.pairs;
      s["pairs_both_named_at_least"] = lower_bound(t.both, t.pairs);
      s["pairs_wrong_at_most"] = upper_bound(t.pairs - t.both - t.part, t.pairs);
      s["pairs_in_part"] = t.part / t.pairs;
      s["pairs_wrong"] = 1.0 - (t.both + t.part) / t.pairs;
    }
    if (t.outside > 0) {
      s["outside_sets"] = t.outside;
      s["outside_nothing_selected"] = t.silent / t.outside;
      s["outside_right_channel_alone"] = t.channel / t.outside;
      s["outside_right_channel_alone_or_in_the_class"] = t.named / t.outside;
    }
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"confusion matrix of the tracing on blind sets"};
  unsigned seeds = 20;
  unsigned first = 1;
  std::vector<double> sizes{5.0, 10.0, 30.0};
  std::vector<std::string> effects = validation::blind_effects();
  std::string out;
  std::string sets;
  app.add_option("--sets", sets);
  app.add_option("--seeds", seeds);
  app.add_option("--first", first);
  app.add_option("--sizes", sizes)->delimiter(',');
  app.add_option("--effects", effects)->delimiter(',');
  app.add_option("--out", out);
  bool required = false;
  bool pairs = false;
  bool intervals = false;
  double minutes = 1e9;
  std::string design = "plain";
  app.add_option("--design", design)->check(CLI::IsMember({"plain", "geometry", "replicates", "dense"}));
  app.add_flag("--intervals", intervals, "profile likelihood of the effects' numbers");
  app.add_option("--minutes", minutes);
  app.add_flag("--pairs", pairs, "two effects at once");
  app.add_flag("--require", required, "exit with 1 when too few answers are right");
  CLI11_PARSE(app, argc, argv);

  if (pairs) {
    effects = {"contact_friction+displacement_offset",    "force_offset+mount_slip",
               "strand_hysteresis+force_offset",          "wire_length+contact_friction",
               "mount_axial_compliance+contact_friction", "plasticity+displacement_offset",
               "contact_position+rate_viscosity",         "natural_curvature+contact_friction"};
  }
  std::vector<Case> cases;
  for (unsigned s = first; s < first + seeds; ++s) {
    if (!pairs && effects.size() != 1) cases.push_back({"none", 0.0, s, design});
    for (const std::string& effect : effects) {
      for (const double size : sizes) cases.push_back({effect, size, s, design});
    }
  }
  std::vector<Outcome> outcomes = sets.empty() ? std::vector<Outcome>(cases.size()) : read_sets(sets, cases);
  std::ofstream journal;
  if (!sets.empty()) journal.open(sets, std::ios::app);
  std::mutex mutex;
  omp_set_max_active_levels(1);
  const auto began = std::chrono::steady_clock::now();
  const auto count = static_cast<std::ptrdiff_t>(cases.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Case& c = cases[static_cast<std::size_t>(i)];
    if (outcomes[static_cast<std::size_t>(i)].finished) continue;
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count() > 60.0 * minutes)
      continue;
    Outcome o;
    try {
      const validation::BlindSet set =
          validation::make_blind_set(c.effect, c.size, c.seed, design_of(c.design));
      const bool absorbed_whole = c.effect == "force_gain";  // scales with EI and EA: no size at all
      if (c.effect != "none" && !absorbed_whole && set.size < 0.8 * c.size) {
        const std::lock_guard lock(mutex);
        o.reached = false;
        o.finished = true;
        outcomes[static_cast<std::size_t>(i)] = o;
        journal << line_of(c, o).dump() << std::endl;
        continue;
      }
      const auto start = std::chrono::steady_clock::now();
      identification::TraceOptions options;
      options.intervals = intervals;
      const identification::Trace t = identification::trace(set.experiment, options);
      o = judge(set, t);
      o.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    } catch (const std::exception& e) {
      o.answer = std::string("error: ") + e.what();
    }
    const std::lock_guard lock(mutex);
    o.finished = true;
    outcomes[static_cast<std::size_t>(i)] = o;
    journal << line_of(c, o).dump() << std::endl;
    fmt::print(
        "{} {} seed {} size {:g} ({:.3g}): {} P {:.3f} {} chi2 {:.3f} class {:.1f} deviates {:.1f} covered "
        "{} ({:.2f} "
        "s)\n",
        o.right ? "ok   " : "WRONG", c.effect, c.seed, c.size, o.made_size, o.answer, o.probability,
        o.leading, o.chi2_dof, o.class_size, fmt::join(o.deviates, " "), o.covered, o.seconds);
    std::fflush(stdout);
    if (!out.empty())
      base::write_text(out, summary(cases, outcomes).dump(1) + "\n");  // kept if the run is stopped
  }

  const nlohmann::json result = summary(cases, outcomes);
  if (!out.empty()) base::write_text(out, result.dump(1) + "\n");
  fmt::print("{}\n", result.dump(1));
  if (!required) return 0;
  // The fewest that a run of some tens of sets may have: two errors in a hundred, one too many in a small
  // run. The few sets outside the catalogue fail when their 95 % upper bound excludes four right answers of
  // five, the share in the stored sets.
  const nlohmann::json& large = result["sizes"][fmt::format("{:g}", sizes.back())];
  const double outside = large.value("outside_sets", 0.0);
  const double named = std::round(outside * large.value("outside_right_channel_alone_or_in_the_class", 1.0));
  const bool good = large.value("right_class", 1.0) >= 0.95 && large.value("pairs_both_named", 1.0) >= 0.85 &&
                    upper_bound(named, outside) >= 0.8 && result["false_alarms"].get<double>() <= 0.2;
  return good ? 0 : 1;
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
