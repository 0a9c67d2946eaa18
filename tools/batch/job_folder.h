#pragma once
// Where a job keeps its checkpoints, so that it goes on in the midst when its batch was killed.

#include <string>

#include "tools/batch/job_steps.h"

namespace spillway::command {

/// The folder for --resume of a step of `job`, beside what it makes: OUTPUT.resume; "" if it cannot
/// go on in the midst, as its output is temporary or no file, or its input is a mesh.
std::string resume_folder(const Job& job, const JobStep& step);

/// Waits until a process that is about to end has let go of the folder, some seconds at most.
void wait_until_unused(const std::string& folder);

}  // namespace spillway::command
