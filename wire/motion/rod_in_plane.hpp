#pragma once

#include "numerics/dae.hpp"
#include "wire/motion/rod_losses.hpp"
#include "wire/motion/rod_model.hpp"
#include "wire/motion/rod_plane.hpp"
#include "wire/motion/rod_rows.hpp"

namespace snare::wire {

/// What RodForces and RodStiffness work out on edges and on vertices between the ends, of a rod that stays in
/// a plane: of the two components there, four edges and then four vertices at a time.        theory.md (M.36)
///
/// four: see RodForces. All in SI units. The forces go to the rows of edges, with energy, losses and what
/// curvatures have; the rows hold the unknowns already.
void work_out_forces(const RodModel& model, const RodPlane& plane, const numerics::DaePoint& at, bool four,
                     RodRows& rows, const RodSums& out);
/// The derivatives go to blocks, see stiffness_blocks.hpp, which are zero before; the rows are those that the
/// forces have left.
void work_out_stiffness(const RodModel& model, const RodPlane& plane, const RodRows& rows, bool four,
                        RodRows& blocks);

}  // namespace snare::wire
