#include "tools/report/task_file.h"

#include "formats/disk/file_system.h"
#include "tools/report/json_text.h"
#include "tools/report/task_json.h"

namespace spillway::command {

TaskFile::TaskFile(const std::string& path) : output_(disk().create(path)) {}

void TaskFile::write(const TaskNode& node) { output_.append(json_text(to_json(node)) + "\n"); }

void TaskFile::begin_again() { output_.append("{\"begun_again\":true}\n"); }

}  // namespace spillway::command
