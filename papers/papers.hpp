#pragma once

#include "papers/figure.hpp"

#include <filesystem>
#include <vector>

namespace snare::papers {

/// Abiko et al.: the loose wire on the bench, on the air table and in the end effector of an arm.
[[nodiscard]] const Paper& abiko();
/// The paper on an end effector of three wires: contact, rigidizing, the constraint test.
[[nodiscard]] const Paper& na();
/// Honda et al. 2014: the capture of the HTV by the SSRMS.
[[nodiscard]] const Paper& honda();

/// All of them, in this order.
[[nodiscard]] std::vector<const Paper*> all_papers();

/// A check a paper, of the rows of its figures; those that another group of rows compares are left out. data:
/// folder of the shipped files.
[[nodiscard]] std::vector<validation::Check> paper_checks(const std::filesystem::path& data);

}  // namespace snare::papers
