#pragma once

#include "wire/mesh.hpp"
#include "wire/specification.hpp"

#include <vector>

namespace snare::wire {

/// An elastic spring in series with a slider (Jenkin element): resultant k (strain - slipped), |resultant| <=
/// k slip_strain. The strain is a curvature [1/m] (k [N m^2]) or an axial strain [-] (k [N]).
struct SliderElement {
  double stiffness = 0.0;    ///< k, > 0
  double slip_strain = 0.0;  ///< strain at which a virgin element begins to slip, > 0
};

/// What a section answers to a strain.
struct SectionResponse {
  double resultant = 0.0;  ///< moment [N m] or axial force [N]
  double tangent = 0.0;    ///< d resultant / d strain
  /// stored, plus what slipping dissipates on the way from the memory, a unit length [J/m].
  double energy = 0.0;
};

/// Elastic spring beside sliders (Masing 1926, Iwan 1967).                           theory.md (W.13)
///
///   resultant = k0 strain + sum_j k_j (strain - p_j),   p_j moved so that |strain - p_j| <= slip strain j
///
/// One slider describes the friction of strands on each other (Papailiou 1997: stiff while they stick, soft
/// when they slip); many describe a section that yields from its outer fibres inwards. elastic: k0 > 0.
/// slipped: p_j of every element, or null for a virgin section (all zero).
/// Of bending: elastic [N m^2], strain and slipped [1/m]; of stretching [N], [-].
[[nodiscard]] SectionResponse respond(double elastic, const std::vector<SliderElement>& elements,
                                      double strain, const double* slipped);

/// Moves the sliders, p_j [1/m] or [-], to where the strain leaves them.
void slide(const std::vector<SliderElement>& elements, double strain, double* slipped);

/// Bending of a round section of an elastic, linearly hardening metal as a sum of sliders, one a pair of
/// fibres at +-y: virgin stiffness EI in all, `hardening` EI of it elastic for good, the fibre at y slipping
/// at the strain yield_strain / y. Fibres at Gauss points of the section; exact yield moment of the outermost
/// within 2 %.
/// bending_stiffness: EI [N m^2]; diameter [m]; yield_strain: yield stress over E [-]; hardening: in (0, 1).
[[nodiscard]] std::vector<SliderElement> yielding_section(double bending_stiffness, double diameter,
                                                          double yield_strain, double hardening);

/// Friction of strands in bending as sliders: one, or of a breadth > 0 ten of equal stiffness, the logarithms
/// of their slip curvatures at the middles of ten equal parts. Of the breadth 2 the moment is within 0.4 % of
/// the continuous distribution's.
[[nodiscard]] std::vector<SliderElement> strand_sliders(const StrandFriction& friction);

/// Slipped strains of all elements: bending ones a vertex, axial ones an edge, of the material that is there
/// while the controls have these values.
struct SectionMemory {
  Controls controls{};
  std::vector<double> bending;  ///< [vertex * elements + element] [1/m]
  std::vector<double> axial;    ///< [edge * elements + element] [-]
};

/// Carries values at the mesh's vertices (or, `of_edges`, at the middles of its edges) over to where other
/// controls put them, by linear interpolation in the material coordinate; material that comes in at a mount
/// is virgin (zero). In their units.
[[nodiscard]] std::vector<double> carried_over(const MaterialMesh& mesh, const std::vector<double>& values,
                                               int components, bool of_edges, const Controls& from,
                                               const Controls& to);

}  // namespace snare::wire
