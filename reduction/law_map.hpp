#pragma once

#include "reduction/wire_file.hpp"

#include <optional>
#include <vector>

namespace snare::reduction {

/// A law with nothing fitted beside the full wire, over slack and travel at mid-span.
struct LawMapRow {
  double slack = 0.0;           ///< negative: pretensioned [m]
  double natural_height = 0.0;  ///< of the wire before the push [m]
  std::vector<double> full;  ///< force of the full wire, one a travel; short where the solve ended early [N]
  std::vector<double> stretched;  ///< Honda et al., eq. 1, at the wire's own EA, length and height [N]
  /// k(EI, T, s) d with the tension before the push, none in a loose wire [N].
  std::vector<double> tensioned;
};

/// Laws without fitted numbers beside the full wire, at one position; see map_laws.
struct LawMap {
  double position = 0.0;       ///< [m]
  std::vector<double> travel;  ///< > 0 [m]
  std::vector<LawMapRow> rows;

  /// Travels over which a law stays within a share of the full force, as the longest run of them; nothing
  /// when none.
  [[nodiscard]] std::optional<Interval> within(const LawMapRow& row,
                                               const std::vector<double> LawMapRow::*law, double share) const;
};

/// Slacks from a pretension by a strain of 0.1 % to the largest slack of the case, elastic wire without
/// friction.
[[nodiscard]] LawMap map_laws(const WireCase& wire, const DistilSettings& settings, int slacks, int travels);

}  // namespace snare::reduction
