#pragma once
// Where things are on the machine that tests were built on.

#include <filesystem>
#include <string>

namespace spillway::test {

/// The built command.
std::string command_path();

/// The same with the subcommand of a product that tests add.
std::string mean_slope_command_path();

/// mpirun; empty in a build without MPI.
std::string mpirun_path();

/// The same as a script begins with it, up to the number of ranks. Containers run tests as root,
/// which mpirun refuses unless it is told twice. What Open MPI never gives back is no leak of ours.
std::string mpirun_command();

/// Sample files outside of the repository; the folder need not be there.
std::filesystem::path shared_data_folder();

/// The pages of this checkout.
std::filesystem::path docs_folder();

}  // namespace spillway::test
