#pragma once

#include "results/benchmark_run.hpp"

#include <string>
#include <vector>

namespace snare::app {

/// report.html of a benchmark: a section a case, its scores and its curves beside the archived ones.
[[nodiscard]] std::string benchmark_page(const study::BenchmarkFile& benchmark,
                                         const std::vector<results::BenchmarkAnswer>& answers,
                                         bool interrupted);

/// A score beside its bar: "+1.2 % (0.1)".
[[nodiscard]] std::string score_words(double score, double bar);

}  // namespace snare::app
