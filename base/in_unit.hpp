#pragma once

namespace snare::base {

/// A number in SI as results show it in a unit of `unit` SI units (1e-3 for mm), the other way of to_si: the
/// decimal number of at most 15 digits that to_si reads as this one, to one part in 2^52, so that 87.75 mm of
/// a file does not come back as 87.75000000000001. A number that is none such keeps all its digits. unit:
/// finite, > 0.
[[nodiscard]] double in_unit(double si, double unit);

/// The same of a number that is in the unit already.
[[nodiscard]] double without_tail(double shown, double unit);

}  // namespace snare::base
