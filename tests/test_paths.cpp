#include "tests/test_paths.h"

namespace spillway::test {

std::string command_path() { return SPILLWAY_COMMAND; }
std::string mean_slope_command_path() { return SPILLWAY_MEAN_SLOPE_COMMAND; }
std::string mpirun_path() { return SPILLWAY_MPIRUN; }
std::filesystem::path shared_data_folder() { return SPILLWAY_SHARED_DATA; }
std::filesystem::path docs_folder() { return SPILLWAY_DOCS; }

}  // namespace spillway::test
