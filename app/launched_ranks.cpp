#include "app/launched_ranks.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace snare::app {

namespace {

/// What launchers set for the processes that they start: Open MPI; MPICH and Intel; Slurm's srun with its
/// PMI.
constexpr const char* sizes[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_SIZE"};

bool launched() {
  for (const char* name : sizes)
    if (std::getenv(name) != nullptr) return true;
  return std::getenv("SLURM_STEP_NUM_TASKS") != nullptr && std::getenv("PMIX_RANK") != nullptr;
}

}  // namespace

std::unique_ptr<study::Ranks> launched_ranks() {
  if (!launched()) return nullptr;
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  // Beside the command in a build tree, in the libraries' folder of an installation. Open MPI's own plug-ins
  // look for its symbols among those of the process, so they must be seen by all.
  for (const char* place : {"snare_mpi.so", "../" SNARE_LIBDIR "/snare/snare_mpi.so"}) {
    const std::filesystem::path file = here / place;
    if (!std::filesystem::exists(file)) continue;
    void* library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (library == nullptr)
      throw std::runtime_error(std::string("cannot open ") + file.string() + ": " + ::dlerror());
    using Make = study::Ranks* (*)();
    const auto make = reinterpret_cast<Make>(::dlsym(library, "snare_make_ranks"));
    if (make == nullptr) throw std::runtime_error(file.string() + " has no snare_make_ranks");
    return std::unique_ptr<study::Ranks>(make());
  }
  throw std::runtime_error(
      "started by mpirun, but this build has no MPI: install libopenmpi-dev (Debian), configure and build "
      "again");
}

}  // namespace snare::app
