#pragma once
// What is remembered of a job beside its outputs, so that --resume knows what is complete and
// unchanged.

#include <string>
#include <vector>

#include "formats/bytes/json.h"
#include "tools/batch/job_steps.h"

namespace spillway::detail {

/// A job under way, or done.
struct JobRun {
  Job job;
  std::vector<JobStep> steps;
  std::string log;                 ///< the file that its messages go to
  std::string record;              ///< the file that save_record() writes
  std::string status = "waiting";  ///< "waiting", "running", "done", "failed", "unchanged"
  std::string error;               ///< the last line of a failed one's log
  double seconds = 0;
  Json inputs;  ///< input_fingerprints() when it began
};

/// Size and time of change of all inputs, to be taken before a job begins. Throws Error if there
/// are none.
Json input_fingerprints(const Job& job);

/// Writes the record of a job that is done or has failed.
void save_record(const JobRun& run);

/// Whether the record tells of the same job, done by the same version, with inputs and outputs as
/// they are now. A record that makes no sense tells of nothing.
bool is_complete_and_unchanged(const JobRun& run);

}  // namespace spillway::detail
