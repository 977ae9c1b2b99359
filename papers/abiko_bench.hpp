#pragma once

#include "papers/figure.hpp"
#include "reduction/wire_file.hpp"

namespace snare::papers {

/// The static test of Abiko et al.: Tables 3 and 4, Figs. 9 to 11.
[[nodiscard]] FigureResult conditions_of_the_wire(Runs& runs);
[[nodiscard]] FigureResult largest_displacement(Runs& runs);
[[nodiscard]] FigureResult forces_at_three_positions(Runs& runs);
[[nodiscard]] FigureResult quadratic_fits(Runs& runs);
[[nodiscard]] FigureResult stiffness_at_three_positions(Runs& runs);

/// The wire that the tracing of the published fits ends with.
[[nodiscard]] reduction::WireCase traced_wire(const Runs& runs);

}  // namespace snare::papers
