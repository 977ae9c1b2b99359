#pragma once

namespace snare::app {

/// Exit statuses of the command.
enum class ExitStatus : int {
  done = 0,
  failure = 1,
  wrong_input = 2,
  solver_stopped = 3,
  row_out_of_limit = 4
};

}  // namespace snare::app
