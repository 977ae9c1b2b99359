#pragma once

#include <complex>

namespace snare::validation {

/// Stiffness of an Euler-Bernoulli span under axial tension, clamped at the far end, at its near end:
/// force and moment for a unit deflection and a unit slope there.
///
/// With EI = 1, length h, u = h sqrt(T), D = 2 (1 - cosh u) + u sinh u, from w'''' - T w'' = 0:
///   deflection  u^3 sinh u / (h^3 D)              -> 12/h^3
///   coupling    u^2 (cosh u - 1) / (h^2 D)        ->  6/h^2   (sign by the side the span lies on)
///   rotation    u (u cosh u - sinh u) / (h D)     ->  4/h
/// In compression u is imaginary. T may carry an infinitesimal imaginary part, whose coefficient in the
/// result is then the derivative (Squire and Trapp 1998). Livesley and Chandler 1956 (stability functions).
struct SpanStiffness {
  std::complex<double> deflection;  ///< [1/m^3] per EI
  std::complex<double> coupling;    ///< [1/m^2] per EI
  std::complex<double> rotation;    ///< [1/m] per EI
};

/// tension: T/EI [1/m^2], any sign; length: h [m], > 0.  Power series below |u| = 1, exponentials scaled
/// so that no tension overflows. A compression that buckles the span by itself gives infinities.
[[nodiscard]] SpanStiffness span_stiffness(std::complex<double> tension, double length);

/// Deflection under a unit transverse load at `position` of a span clamped at both ends, EI = 1 [m^3 per EI].
///   G = 1 / (K_ww - K_wt^2 / K_tt), K the sum over both sides of the load.
/// tension: T/EI [1/m^2]; length > 0 [m]; position in (0, length) [m].
[[nodiscard]] std::complex<double> point_load_compliance(std::complex<double> tension, double length,
                                                         double position);

}  // namespace snare::validation
