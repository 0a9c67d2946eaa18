#pragma once

#include "formats/bytes/json.h"
#include "stream/plan/run_trace.h"

namespace spillway::command {

/// A line of --tasks, and an item of "task_sums" of --stats. docs/cli.md lists their keys.
Json to_json(const TaskNode& node);
Json to_json(const TaskSum& sum);

}  // namespace spillway::command
