#pragma once

#include "identification/fitting/prediction.hpp"
#include "results/result_table.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace snare::results {

/// A further column of curves.csv: one vector a series, aligned with the series' displacements; cells beyond
/// the end of a vector stay empty.
struct CurveColumn {
  std::string name;
  std::vector<std::vector<double>> values;
};

/// The table of curves.csv: a row a point of every prediction, in the order in which the points were reached.
/// Columns: docs/curves_csv.md.
void give_curves(TableSink& sink, const std::vector<identification::Series>& series,
                 const std::vector<identification::Prediction>& predictions,
                 const std::vector<CurveColumn>& more = {});

/// The same, written into a file.
void write_curves(const std::filesystem::path& file, const std::vector<identification::Series>& series,
                  const std::vector<identification::Prediction>& predictions,
                  const std::vector<CurveColumn>& more = {});

}  // namespace snare::results
