#include "tools/batch/job_record.h"

#include <spillway/input.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>

#include "tools/report/json_text.h"
#include "tools/report/text_output.h"

namespace spillway::detail {
namespace {

/// A file's path, size and time of change; the latter two are null where there is none.
Json fingerprint(const std::string& path) {
  struct stat status {};
  Json json = {{"path", path}, {"bytes", nullptr}, {"changed", nullptr}};
  if (::stat(path.c_str(), &status) != 0) return json;
  json["bytes"] = status.st_size;
  json["changed"] = status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec;
  return json;
}

/// All that decides whether a job has to be done again.
Json description(const JobRun& run, const Json& inputs) {
  Json json;
  json["version"] = SPILLWAY_VERSION;
  json["steps"] = Json::array();
  json["outputs"] = Json::array();
  for (const JobStep& step : run.steps) {
    // A temporary file's name is another one each time.
    std::vector<std::string> arguments = step.arguments;
    for (const JobStep& other : run.steps) {
      if (other.temporary)
        std::replace(arguments.begin(), arguments.end(), other.output, std::string("-"));
    }
    json["steps"].push_back(arguments);
    if (!step.temporary) json["outputs"].push_back(fingerprint(step.output));
  }
  json["inputs"] = inputs;
  return json;
}

}  // namespace

Json input_fingerprints(const Job& job) {
  Json json = Json::array();
  for (const std::string& input : spillway::expand_inputs(job.inputs, Context())) {
    json.push_back(fingerprint(input));
  }
  return json;
}

void save_record(const JobRun& run) {
  Json json = {{"name", run.job.name}, {"status", run.status}, {"seconds", run.seconds}};
  json["error"] = run.error.empty() ? Json(nullptr) : Json(run.error);
  // A failed job may have failed for want of its inputs.
  json["job"] = run.status == "done" ? description(run, run.inputs) : Json(nullptr);
  write_text(run.record, json_text(json, 2) + "\n");
}

bool is_complete_and_unchanged(const JobRun& run) {
  std::ifstream file(run.record);
  if (!file) return false;
  try {
    const Json record = parse_json(std::string(std::istreambuf_iterator(file), {}));
    const Json* const status = record.find("status");
    const Json* const job = record.find("job");
    return status != nullptr && *status == Json("done") && job != nullptr &&
           *job == description(run, input_fingerprints(run.job));
  } catch (const std::exception&) {
    return false;  // no record, or inputs that are not there: the job itself says so
  }
}

}  // namespace spillway::detail
