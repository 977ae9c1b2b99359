// snare_first: the main job alone, as `snare reproduce --out out/reproduce` does it (app/CMakeLists.txt).
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/exit_status.hpp"
#include "app/interruption.hpp"
#include "app/result_folder.hpp"

#include <cstdio>
#include <exception>

int main() {
  snare::app::catch_interrupts(snare::base::release_result_folders);
  try {
    const snare::app::KeepWhenInterrupted word({}, "");
    snare::app::CommonOptions options;
    options.out = "out/reproduce";
    options.command = "snare reproduce";
    snare::app::Console console(false);
    return static_cast<int>(snare::app::run_reproduce({}, options, console));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(snare::app::ExitStatus::failure);
  }
}
