#pragma once
// What is remembered of a job beside its outputs, so that --resume knows what is complete and
// unchanged, and what had begun.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/bytes/json.h"
#include "tools/batch/job_steps.h"

namespace spillway::command {

/// A job under way, or done.
struct JobRun {
  Job job;
  std::vector<JobStep> steps;
  std::string log;                 ///< the file that its messages go to
  std::string record;              ///< the file that save_record() writes
  std::string resume_folder;       ///< of its first step; "" if this cannot go on in the midst
  std::uint64_t memory = 0;        ///< its share once it has begun, in bytes
  std::string status = "waiting";  ///< "waiting", "running", "done", "failed", "unchanged"
  std::string error;               ///< the last line of a failed one's log
  double seconds = 0;
  Json inputs;  ///< input_fingerprints() when it began
};

/// Size and time of change of all inputs, to be taken before a job begins. Throws Failure if there
/// are none.
Json input_fingerprints(const Job& job);

/// Writes the record of a job that is under way, is done or has failed.
void save_record(const JobRun& run);

/// Removes the records of these jobs, in one folder, that a batch was writing when it was killed.
void remove_unfinished_records(const std::string& folder, const std::vector<JobRun>& runs);

/// Whether the record tells of the same job, done by the same version, with inputs and outputs as
/// they are now. A record that makes no sense tells of nothing.
bool is_complete_and_unchanged(const JobRun& run);

/// The share of memory that the same job had, of the same version and with the same inputs, by the
/// record, when it was interrupted or failed and left its resume_folder. A run goes on with no
/// other. Nothing if it has to begin.
std::optional<std::uint64_t> memory_to_go_on_with(const JobRun& run);

}  // namespace spillway::command
