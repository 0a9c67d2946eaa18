#pragma once

#include <string>
#include <vector>

#include "tools/batch/job_list.h"
#include "tools/options/command_line.h"

namespace spillway::command {

/// A kind of output: what makes it, and how.
struct OutputKind {
  std::string subcommand;
  std::vector<std::string> arguments;
  bool is_lonlat = false;  ///< longitude and latitude, which --force-crs permits to be others
};

/// One run of a subcommand within a job.
struct JobStep {
  std::vector<std::string> arguments;  ///< the subcommand first
  std::vector<std::string> options;    ///< the names of those of the job's options that it takes
  std::string output;                  ///< the file it makes
  bool temporary = false;              ///< `output` only serves later steps
};

/// What a job is made of.
class JobPlanner {
 public:
  /// `root` has all subcommands; outputs go to `folder`, what is only needed meanwhile to
  /// `scratch`.
  JobPlanner(const CommandLine& root, std::string folder, std::string scratch);

  /// The steps of a job, in order: rasters of points are made of the points, and so is a single
  /// output besides; several are made of one triangulation. Throws UsageError that names the job
  /// for a kind of output or an option that there is not.
  [[nodiscard]] std::vector<JobStep> plan(const Job& job) const;

  /// Whether a subcommand knows an option by this long name, of which an output comes.
  [[nodiscard]] bool has_option(const std::string& subcommand, const std::string& name) const;

 private:
  [[nodiscard]] JobStep step(const Job& job, const std::string& kind,
                             const std::vector<std::string>& inputs, bool of_points) const;
  [[nodiscard]] JobOptions options_of_step(const Job& job, const OutputKind& kind, bool of_points,
                                           std::vector<std::string>& taken) const;
  [[nodiscard]] bool takes_option(const Job& job, const OutputKind& kind, bool of_points,
                                  const std::string& name) const;
  void check_options(const Job& job, const std::vector<JobStep>& steps) const;

  const CommandLine& root_;
  std::string folder_;
  std::string scratch_;
};

/// Whether a job makes what is wrong along the joins with its neighbours, of which it has no
/// points: rasters and contours.
bool has_seams(const Job& job);

/// What the filter by place among a job's options leaves of the plane.
Box<2> wanted_place(const Job& job);

/// The subcommands whose options a job may have.
const std::vector<std::string>& job_subcommands();

}  // namespace spillway::command
