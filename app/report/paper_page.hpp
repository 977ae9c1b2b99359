#pragma once

#include "papers/papers.hpp"

#include <string>
#include <vector>

namespace snare::app {

/// The page of a paper: figure by figure what its text says, how it is made, the curves, the numbers
/// compared; what is lost.
/// results: of the first figures of the paper, fewer where the run was interrupted. version: of the command.
[[nodiscard]] std::string paper_page(const papers::Paper& paper,
                                     const std::vector<papers::FigureResult>& results,
                                     const std::string& version);

}  // namespace snare::app
