#include "tests/test_paths.h"

namespace spillway::test {

std::string command_path() { return SPILLWAY_COMMAND; }
std::string mean_slope_command_path() { return SPILLWAY_MEAN_SLOPE_COMMAND; }
std::string mpirun_path() { return SPILLWAY_MPIRUN; }
std::string mpirun_command() {
  return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 ASAN_OPTIONS=detect_leaks=0 " +
         mpirun_path() + " --oversubscribe --bind-to none";
}
std::filesystem::path shared_data_folder() { return SPILLWAY_SHARED_DATA; }
std::filesystem::path docs_folder() { return SPILLWAY_DOCS; }

}  // namespace spillway::test
