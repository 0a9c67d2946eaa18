#pragma once
// What `spillway batch` is to do: docs/batch.md.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "formats/disk/file_system.h"
#include "src/geometry/box.h"

namespace spillway::command {

/// Options by their long names without dashes; flags have no values.
using JobOptions = std::map<std::string, std::vector<std::string>>;

/// Where a job's points lie that has others' around its own.
struct JobArea {
  Box<2> points;  ///< that are read
  Box<2> raster;  ///< what a raster of them covers
};

/// One job: some inputs, and what is to be made of them.
struct Job {
  std::string name;                 ///< what its files are called; unique
  std::vector<std::string> inputs;  ///< as the command line takes them
  std::vector<std::string> to;      ///< kinds of output: "ply", "dem.tif"
  JobOptions options;
  /// How far around its own points those of other jobs are read, too; nothing if that is not said.
  std::optional<double> buffer{};
  /// With a buffer, once it is known where the points of all jobs lie (job_buffers.h).
  std::optional<JobArea> area{};
};

/// The jobs of a list, a file in JSON or TOML; `to` and `options` are what the command line says:
/// the command line's options go before the list's, its `to` serves where the list has none.
/// Relative paths are those of the list's folder. Throws Failure that names the list, the job and the
/// key.
std::vector<Job> read_job_list(FileSystem& files, const std::string& path,
                               const std::vector<std::string>& to, const JobOptions& options);

/// One job for each file.
std::vector<Job> jobs_of_files(const std::vector<std::string>& files,
                               const std::vector<std::string>& to, const JobOptions& options);

/// Whether `path` is a job list by its extension: .json or .toml.
bool is_job_list(const std::string& path);

}  // namespace spillway::command
