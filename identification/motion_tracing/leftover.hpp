#pragma once

#include "identification/records/record_fit.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// How much of what is left over hangs on one thing: a function of it, of twenty steps, found on every other
/// twentieth of the time and tried on the rest. Nothing of it is added to the model.         theory.md (I.24)
struct Leftover {
  std::string sensor;  ///< channel whose residual it is
  std::string on;      ///< "time", "value", "rate", "direction", or another channel
  double share = 0.0;  ///< of the residual's mean square that carries over; negative: nothing does
};

/// For every fitted channel, best first.
[[nodiscard]] std::vector<Leftover> leftovers(const RecordModel& model, const RecordData& data,
                                              const RecordFit& fit);

}  // namespace snare::identification
