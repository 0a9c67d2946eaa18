#include "tools/batch/job_record.h"

#include <spillway/input.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "formats/disk/unfinished_files.h"
#include "tools/report/json_text.h"
#include "tools/report/text_output.h"

namespace spillway::command {
namespace {

namespace fs = std::filesystem;

/// A file's path, size and time of change; the latter two are null where there is none.
Json fingerprint(const std::string& path) {
  struct stat status {};
  Json json = {{"path", path}, {"bytes", nullptr}, {"changed", nullptr}};
  if (::stat(path.c_str(), &status) != 0) return json;
  json["bytes"] = status.st_size;
  json["changed"] = status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec;
  return json;
}

/// Whether a job's outputs are compared, too: not before it is complete.
enum class Outputs { kComplete, kUnfinished };

/// All that decides whether a job has to be done again.
Json description(const JobRun& run, const Json& inputs, Outputs outputs) {
  Json json;
  json["version"] = SPILLWAY_VERSION;
  json["steps"] = Json::array();
  const bool complete = outputs == Outputs::kComplete;
  if (complete) json["outputs"] = Json::array();
  for (const JobStep& step : run.steps) {
    // A temporary file's name is another one each time.
    std::vector<std::string> arguments = step.arguments;
    for (const JobStep& other : run.steps) {
      if (other.temporary)
        std::replace(arguments.begin(), arguments.end(), other.output, std::string("-"));
    }
    json["steps"].push_back(arguments);
    if (complete && !step.temporary) json["outputs"].push_back(fingerprint(step.output));
  }
  json["inputs"] = inputs;
  return json;
}

/// Null if there is no record, or none that makes sense.
Json read_record(const JobRun& run) {
  std::ifstream file(run.record);
  if (!file) return nullptr;
  try {
    return parse_json(std::string(std::istreambuf_iterator(file), {}));
  } catch (const JsonError&) {
    return nullptr;
  }
}

/// Whether a record is of the same job. One with inputs that are not there is not: the job itself
/// says so.
bool is_of_job(const Json& record, const JobRun& run, Outputs outputs) {
  const Json* const job = record.find("job");
  if (job == nullptr) return false;
  try {
    return *job == description(run, input_fingerprints(run.job), outputs);
  } catch (const std::exception&) {
    return false;
  }
}

/// Whether a job that is not done can go on with what it has left.
bool can_go_on(const JobRun& run) {
  return !run.resume_folder.empty() && !run.inputs.is_null() && run.memory > 0 &&
         (run.status == "running" || fs::exists(run.resume_folder));
}

}  // namespace

Json input_fingerprints(const Job& job) {
  Json json = Json::array();
  for (const std::string& input : expand_inputs(job.inputs, Context())) {
    json.push_back(fingerprint(input));
  }
  return json;
}

void save_record(const JobRun& run) {
  Json json = {{"name", run.job.name}, {"status", run.status}, {"seconds", run.seconds}};
  json["error"] = run.error.empty() ? Json(nullptr) : Json(run.error);
  json["job"] = nullptr;  // a failed job may have failed for want of its inputs
  if (run.status == "done") {
    json["job"] = description(run, run.inputs, Outputs::kComplete);
  } else if (can_go_on(run)) {
    json["job"] = description(run, run.inputs, Outputs::kUnfinished);
    json["memory"] = run.memory;
  }
  write_text(run.record, json_text(json, 2) + "\n");
}

void remove_unfinished_records(const std::string& folder, const std::vector<JobRun>& runs) {
  std::vector<fs::path> left;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    if (entry->path().extension() != ".part") continue;
    const bool is_of_record = std::ranges::any_of(runs, [&](const JobRun& run) {
      return is_temporary_path(entry->path(), (fs::path(folder) / fs::path(run.record).filename()));
    });
    if (is_of_record) left.push_back(entry->path());
  }
  for (const fs::path& path : left) fs::remove(path, ignored);
}

bool is_complete_and_unchanged(const JobRun& run) {
  const Json record = read_record(run);
  const Json* const status = record.find("status");
  return status != nullptr && *status == Json("done") && is_of_job(record, run, Outputs::kComplete);
}

std::optional<std::uint64_t> memory_to_go_on_with(const JobRun& run) {
  if (run.resume_folder.empty() || !fs::exists(run.resume_folder)) return {};
  const Json record = read_record(run);
  if (!is_of_job(record, run, Outputs::kUnfinished)) return {};
  const Json* const memory = record.find("memory");
  if (memory == nullptr || !memory->is_number()) return {};
  const double bytes = memory->number();
  if (!(bytes >= 1 && bytes < 0x1p53)) return {};
  return static_cast<std::uint64_t>(bytes);
}

}  // namespace spillway::command
