#pragma once

namespace snare::test {

/// Until the allocation of this thread that fails, with it; 0: none does.
extern thread_local long allocations_left;

}  // namespace snare::test
