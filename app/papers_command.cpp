#include "app/commands.hpp"
#include "app/interruption.hpp"
#include "app/report/paper_page.hpp"
#include "app/result_folder.hpp"
#include "app/row_json.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "papers/papers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace snare::app {

namespace {

using nlohmann::json;
using papers::Figure;
using papers::FigureResult;
using papers::Paper;

constexpr const char* figures_file = "figures.json";
constexpr const char* all_of_them = "all";

const char* word_of(papers::Origin origin) {
  switch (origin) {
    case papers::Origin::published:
      return "published";
    case papers::Origin::record:
      return "record";
    case papers::Origin::computed:
      break;
  }
  return "computed";
}

json figure_json(const Figure& figure, const FigureResult& result) {
  json panels = json::array(), rows = json::array();
  for (std::size_t k = 0; k < figure.panels.size(); ++k) {
    const papers::Panel& panel = figure.panels[k];
    json curves = json::array();
    for (const papers::FigureCurve& curve : result.curves) {
      if (curve.panel != k) continue;
      json one{{"name", curve.name}, {"origin", word_of(curve.origin)}, {"x", curve.x}, {"y", curve.y}};
      if (curve.scatter > 0.0) one["scatter"] = curve.scatter;
      curves.push_back(std::move(one));
    }
    panels.push_back({{"title", panel.title},
                      {"x", {{"quantity", panel.x.quantity}, {"unit", panel.x.unit}}},
                      {"y", {{"quantity", panel.y.quantity}, {"unit", panel.y.unit}}},
                      {"curves", std::move(curves)}});
  }
  for (const validation::Row& row : result.rows) rows.push_back(row_json(row));
  return {{"number", figure.number},
          {"title", figure.title},
          {"text", figure.text},
          {"method", figure.method},
          {"panels", std::move(panels)},
          {"table", {{"columns", result.table.columns}, {"rows", result.table.rows}}},
          {"findings", result.findings},
          {"rows", std::move(rows)},
          {"compared_in", figure.compared_in},
          {"failure", result.failure}};
}

/// What is made of one paper.
struct MadePaper {
  const Paper* paper;
  std::vector<FigureResult> figures = {};  ///< of its first figures

  [[nodiscard]] bool whole() const { return figures.size() == paper->figures.size(); }
  [[nodiscard]] std::string page() const { return std::string(paper->name) + ".html"; }
  [[nodiscard]] std::pair<std::size_t, std::size_t> rows_and_out() const {
    std::size_t rows = 0, out = 0;
    for (const FigureResult& figure : figures) {
      rows += figure.rows.size();
      out += static_cast<std::size_t>(
          std::ranges::count_if(figure.rows, [](const validation::Row& r) { return !r.within(); }));
    }
    return {rows, out};
  }
};

json paper_json(const MadePaper& made) {
  json figures = json::array(), lost = json::array();
  for (std::size_t k = 0; k < made.figures.size(); ++k)
    figures.push_back(figure_json(made.paper->figures[k], made.figures[k]));
  for (const papers::Lost& one : made.paper->lost) lost.push_back({{"what", one.what}, {"why", one.why}});
  return {{"name", made.paper->name},
          {"title", made.paper->title},
          {"page", made.page()},
          {"figures", std::move(figures)},
          {"lost", std::move(lost)}};
}

/// The papers that are asked for, figure by figure; another thread may keep the finished ones at any time.
class Work {
 public:
  Work(const CommonOptions& options, const std::vector<const Paper*>& asked) : options_(options) {
    for (const Paper* paper : asked) made_.push_back({paper});
  }

  [[nodiscard]] ExitStatus all(Console& console) {
    papers::Runs runs(data_directory(),
                      {[&console](const std::string& stage) { console.progress(stage); }, interrupted});
    const KeepWhenInterrupted keeping([this] { return keep(); }, "");
    ExitStatus status = ExitStatus::done;
    try {
      for (MadePaper& made : made_) {
        for (const Figure& figure : made.paper->figures) {
          FigureResult result = attempt(*made.paper, figure, runs);
          if (!result.failure.empty()) {
            console.complain(fmt::format("{}, {}: {}", made.paper->name, figure.number, result.failure));
            status = ExitStatus::solver_stopped;
          }
          const std::scoped_lock lock(mutex_);
          made.figures.push_back(std::move(result));
          if (made.whole()) write_page(made);
        }
        console.end_progress();
        if (!options_.json) console.say(words_of(made));
      }
    } catch (const papers::Stopped&) {
      status = ExitStatus::solver_stopped;
    }
    console.end_progress();
    begin_writing();
    if (!whole())
      console.complain(keep());
    else
      write_json();
    return status;
  }

 private:
  /// A figure, or the reason for its absence. The others are made even if one fails.
  static FigureResult attempt(const Paper& paper, const Figure& figure, papers::Runs& runs) {
    try {
      return papers::made(paper, figure, runs);
    } catch (const papers::Stopped&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      FigureResult failed;
      failed.failure = error.what();
      return failed;
    }
  }

  [[nodiscard]] bool whole() const { return std::ranges::all_of(made_, &MadePaper::whole); }
  void write_page(const MadePaper& made) const {
    base::write_text(options_.out / made.page(), paper_page(*made.paper, made.figures, version()));
  }
  void write_json() const {
    json all{{"schema", "snare-figures/1"},
             {"version", version()},
             {"interrupted", !whole()},
             {"papers", json::array()}};
    for (const MadePaper& made : made_)
      if (!made.figures.empty()) all["papers"].push_back(paper_json(made));
    write_result(options_, figures_file, all);
  }

  [[nodiscard]] std::string words_of(const MadePaper& made) const {
    const auto [rows, out] = made.rows_and_out();
    return fmt::format(
        "{}: {} figures and tables, {} numbers and statements compared, {} out of their limit; wrote {}",
        made.paper->name, made.figures.size(), rows, out, (options_.out / made.page()).string());
  }

  /// Writes the finished figures and names them.
  std::string keep() {
    const std::scoped_lock lock(mutex_);
    std::size_t figures = 0;
    for (const MadePaper& made : made_) {
      figures += made.figures.size();
      if (!made.figures.empty() && !made.whole()) write_page(made);
    }
    write_json();
    return fmt::format("interrupted: {} finished figures and tables are kept and marked as a part", figures);
  }

  const CommonOptions& options_;
  std::vector<MadePaper> made_;
  std::mutex mutex_;  // of made_
};

}  // namespace

ExitStatus run_reproduce_word(const std::filesystem::path& what, const CommonOptions& options,
                              Console& console) {
  const std::string word = what.string();
  std::vector<const Paper*> asked = papers::all_papers();
  std::vector<std::string> names;
  for (const Paper* paper : asked) names.emplace_back(paper->name);
  names.emplace_back(all_of_them);
  if (std::ranges::find(names, word) == names.end()) {
    if (!word.empty() && !what.has_extension() && !std::filesystem::exists(what))
      throw base::InputError(
          {"", 0, "snare reproduce", word,
           fmt::format("must be an experiment file or a paper: {}", fmt::join(names, ", "))});
    return run_reproduce(what, options, console);
  }
  if (!options.overrides.empty())
    throw base::InputError({"--set", 0, options.overrides.front(), "",
                            "a paper is made from the shipped files, so there is no key to set; snare "
                            "simulate and snare reproduce "
                            "EXPERIMENT.toml take one"});
  if (word != all_of_them) std::erase_if(asked, [&word](const Paper* paper) { return paper->name != word; });
  const ResultFolder folder(options, {"abiko.html", "na.html", "honda.html", figures_file});
  return Work(options, asked).all(console);
}

}  // namespace snare::app
