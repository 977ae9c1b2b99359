#pragma once

#include "papers/runs.hpp"
#include "validation/suite.hpp"

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace snare::papers {

/// A quantity along an axis of a figure and its unit; no unit for a pure number.
struct Axis {
  const char* quantity;
  const char* unit;
};

/// One pair of axes of a figure.
struct Panel {
  const char* title;
  Axis x, y;
  bool to_scale = false;  ///< one unit is equally long on both axes
};

/// A case by the name that a figure gives it.
struct NamedCase {
  const char* name;
  Case (*run)(Runs& runs);
};

/// Where a curve comes from.
enum class Origin {
  published,  ///< the paper's printed numbers
  computed,
  record  ///< synthetic readings in place of unpublished ones
};

/// One curve of a figure, in the units of its panel.
struct FigureCurve {
  std::string name;
  Origin origin = Origin::computed;
  std::vector<double> x = {}, y = {};  ///< [unit of the panel's axis]
  std::size_t panel = 0;
  double scatter = 0.0;  ///< standard deviation of a reading about the curve, in the unit of y; 0: unknown
};

/// Numbers of a figure that are no curve, as texts.
struct FigureTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows = {};  ///< each as long as columns
};

/// What was computed for a figure or a table of a paper.
struct FigureResult {
  std::vector<FigureCurve> curves;
  FigureTable table;
  std::vector<validation::Row> rows;  ///< comparisons with numbers and statements of the text
  std::vector<std::string> findings;  ///< sentences
  const Run* scene = nullptr;         ///< motion that is drawn in three dimensions; owned by Runs
  std::string failure;                ///< why a part is missing; empty: nothing is
};

/// A curve that is a column of a run's history or telemetry.
struct HistoryCurve {
  const char* name;
  Case (*run)(Runs& runs);
  const char* y;  ///< column of history.csv or telemetry.csv
  std::size_t panel = 0;
  double factor = 1.0;                   ///< from the unit of the column to that of the panel
  const char* x = "time_s";              ///< column of the same table
  double (*zero)(const Run&) = nullptr;  ///< offset that is subtracted from x; null: 0
  double from = -std::numeric_limits<double>::infinity();  ///< range of time shown [s]
  double to = std::numeric_limits<double>::infinity();
};

/// A figure or a table of a paper and how it is made.
struct Figure {
  const char* number;  ///< "Fig. 11", "Table 4"
  const char* title;
  const char* text;    ///< statement of the paper
  const char* method;  ///< computation and assumptions
  std::vector<Panel> panels = {};
  std::vector<HistoryCurve> curves = {};
  FigureResult (*compute)(Runs& runs) = nullptr;  ///< everything else; null: there is nothing else
  /// Group of rows of `snare validate` that compares what this figure shows; empty: `rows` do.
  const char* compared_in = "";
};

/// A figure or a number of a paper that cannot be made, or that was assumed.
struct Lost {
  const char* what;
  const char* why;
};

/// Lists of figures or of curves, one after the other.
template <class T>
[[nodiscard]] std::vector<T> joined(std::initializer_list<std::vector<T>> parts) {
  std::vector<T> all;
  for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// A paper with all that is made of it.
struct Paper {
  const char* name;  ///< on the command line
  const char* title;
  const char* short_title;  ///< "Abiko et al."
  std::vector<Figure> figures;
  std::vector<Lost> lost;
};

/// Computes a figure. Its rows get the paper and the figure as group, name and source. Throws `Stopped` where
/// somebody wants the work to end.
[[nodiscard]] FigureResult made(const Paper& paper, const Figure& figure, Runs& runs);

/// A statement of a paper that holds or does not.
[[nodiscard]] validation::Row statement(const std::string& what, validation::Kind kind, bool holds);

/// A number that a paper prints and that a shipped file uses.
struct Input {
  const char* quantity;
  const char* unit;
  double printed;
  double used;
  double last_digit;  ///< one in the last printed place, in the unit
};
/// A table of inputs with a row each, which may differ by half of the last printed digit.
[[nodiscard]] FigureResult inputs(const std::vector<Input>& all, validation::Kind kind);

/// A number, in whatever unit, with that many significant digits; whole numbers below a million keep all of
/// theirs.
[[nodiscard]] std::string digits(double value, int significant = 4);

}  // namespace snare::papers
