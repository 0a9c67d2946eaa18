#include "tools/batch/job_folder.h"

#include <spillway/context.h>
#include <spillway/input.h>

#include <filesystem>

#include "formats/disk/folder_lock.h"
#include "formats/disk/output_check.h"
#include "src/error.h"

namespace spillway::command {
namespace {

/// Whether a job reads one mesh in place of points. What cannot be opened is told by the job.
bool reads_a_mesh(const Job& job) {
  if (job.options.contains("input-format")) return false;
  if (job.options.contains("mesh-format")) return true;
  const std::string& path = job.inputs.front();
  // What a pipe gives can be read once.
  if (job.inputs.size() > 1 || stands_for_several(path) ||
      !std::filesystem::is_regular_file(path)) {
    return false;
  }
  try {
    return kind_of_input(path, Context()) == InputKind::kMesh;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::string resume_folder(const Job& job, const JobStep& step) {
  const bool goes_on = !step.temporary && can_be_tried(step.output) && !reads_a_mesh(job);
  return goes_on ? step.output + ".resume" : "";
}

void wait_until_unused(const std::string& folder) {
  const FolderLock lock((std::filesystem::path(folder) / "").string());
}

}  // namespace spillway::command
