#pragma once
// A run that is one of several processes, started by mpirun or Slurm.

#include <spillway/context.h>

#include <memory>
#include <string>

#include "src/distributed/ranks.h"
#include "src/error.h"

namespace spillway::command {

/// The ranks that this process works with, joined at the first call; null if it was started alone.
const distributed::Ranks* join_ranks();

/// The same for the library; null likewise.
std::shared_ptr<Executor> rank_executor();

/// Throws UsageError, at rank 0, unless all ranks were given the same options (lines of
/// name=value), but for those that each may have of its own. Joins the ranks. Collective.
void check_same_options(const std::string& options);

/// Leaves the others in order; to be called before the process ends well.
void leave_ranks();

/// Whether this process does what is to be done once for the whole job, such as to report: it does
/// if it is alone.
bool is_first_rank();

/// Reports an error on standard error, once for the job if all ranks have it, and ends all ranks.
/// Says nothing, and stops this thread, where a signal is ending the run. Returns only if this
/// process was started alone, or if the ranks have not been joined yet; the exit code is for main.
int report_error(const Failure& error, int exit_code);

/// Ends all ranks without a message, where report_error() would end them.
int end_quietly(int exit_code);

}  // namespace spillway::command
