#pragma once
// Jobs whose points lie side by side: docs/batch.md.

#include <spillway/context.h>

#include <functional>
#include <string>
#include <vector>

#include "tools/batch/job_list.h"

namespace spillway::command {

/// Gives each job that has a buffer the inputs of the others that reach into it, in the order of
/// the jobs, so that the first of equal points is that of a run of all inputs; and the area of its
/// points and rasters. A job that cannot be told where it lies stays as it is, with a warning. Of
/// the others, warns of those that would need a buffer.
void add_buffers(std::vector<Job>& jobs, const Context& context,
                 const std::function<void(const std::string&)>& warn);

}  // namespace spillway::command
