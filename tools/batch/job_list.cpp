#include "tools/batch/job_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/bytes/input_bytes.h"
#include "formats/bytes/json.h"
#include "formats/bytes/whole_file.h"
#include "formats/disk/extension.h"
#include "formats/disk/file_system.h"
#include "tools/batch/toml.h"
#include "tools/options/former_names.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

std::string read_text(FileSystem& files, const std::string& path) {
  InputBytes source(files.open(path));
  return std::string(as_text(read_whole(source)));
}

Json json_of(const toml::node& node) {
  if (const auto* table = node.as_table()) {
    Json json = Json::object();
    for (const auto& [key, value] : *table) json[std::string(key.str())] = json_of(value);
    return json;
  }
  if (const auto* array = node.as_array()) {
    Json json = Json::array();
    for (const toml::node& value : *array) json.push_back(json_of(value));
    return json;
  }
  if (const auto value = node.value_exact<std::string>()) return *value;
  if (const auto value = node.value_exact<std::int64_t>()) return *value;
  if (const auto value = node.value_exact<double>()) return *value;
  if (const auto value = node.value_exact<bool>()) return *value;
  return nullptr;  // a date: refused like anything else that is no text, number or truth value
}

Json parse_list(FileSystem& files, const std::string& path) {
  const std::string text = read_text(files, path);
  if (extension_of(path) == "json") {
    try {
      return parse_json(text);
    } catch (const JsonError& error) {
      throw Failure(
          fmt::format("{}, byte {}: this is not JSON; {}", path, error.byte(), error.what()));
    }
  }
  try {
    return json_of(toml::parse(text));
  } catch (const toml::parse_error& error) {
    throw Failure(fmt::format("{}, line {}: this is not TOML; {}", path, error.source().begin.line,
                              error.description()));
  }
}

class ListReader {
 public:
  ListReader(FileSystem& files, const std::string& path)
      : files_(files), path_(path), folder_(std::filesystem::path(path).parent_path()) {}

  std::vector<Job> read(const std::vector<std::string>& to, const JobOptions& options) {
    const Json list = parse_list(files_, path_);
    where_ = path_;
    expect_keys(list, {"to", "options", "buffer", "jobs"});
    Job defaults;
    const Json* const outputs = list.find("to");
    defaults.to = outputs != nullptr ? texts(*outputs, "to") : to;
    if (const Json* const common = list.find("options")) add_options(*common, defaults.options);
    if (const Json* const buffer = list.find("buffer")) defaults.buffer = length(*buffer, "buffer");
    const Json* const entries = list.find("jobs");
    if (entries == nullptr || !entries->is_array() || entries->elements().empty()) {
      fail("there is no list \"jobs\" with at least one job");
    }
    std::vector<Job> jobs;
    for (const Json& entry : entries->elements()) {
      where_ = fmt::format("{}, job {}", path_, jobs.size() + 1);
      jobs.push_back(read_job(entry, defaults));
      for (const auto& [name, values] : options) jobs.back().options[name] = values;
    }
    return jobs;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Failure(fmt::format("{}: {}", where_, what));
  }

  void expect_keys(const Json& object, const std::set<std::string>& known) const {
    if (!object.is_object()) fail("this is not a table of keys and values");
    for (const auto& [key, value] : object.members()) {
      if (!known.contains(key)) fail(fmt::format("the key \"{}\" is not known", key));
    }
  }

  Job read_job(const Json& entry, const Job& defaults) const {
    expect_keys(entry, {"name", "in", "to", "options", "buffer"});
    Job job = defaults;
    const Json* const inputs = entry.find("in");
    if (inputs == nullptr) fail("the key \"in\" is missing: it names the points");
    for (const std::string& input : texts(*inputs, "in")) {
      const bool list = input.starts_with('@');
      job.inputs.push_back(
          fmt::format("{}{}", list ? "@" : "", (folder_ / input.substr(list ? 1 : 0)).string()));
    }
    if (job.inputs.empty()) fail("\"in\" is empty: it names the points");
    if (const Json* const to = entry.find("to")) job.to = texts(*to, "to");
    if (job.to.empty()) fail("\"to\" is missing: it names the outputs, like [\"ply\"]");
    if (const Json* const own = entry.find("options")) add_options(*own, job.options);
    if (const Json* const own = entry.find("buffer")) job.buffer = length(*own, "buffer");
    const Json* const name = entry.find("name");
    job.name = name != nullptr ? text(*name, "name")
                               : std::filesystem::path(job.inputs.front()).stem().string();
    return job;
  }

  void add_options(const Json& object, JobOptions& options) const {
    if (!object.is_object()) fail("\"options\" is not a table of names and values");
    for (const auto& [given_name, value] : object.members()) {
      const std::string name = present_name(given_name);
      if (name != given_name && object.find(name) != nullptr) {
        fail(
            fmt::format("\"{}\" is the former name of \"{}\": give one of them", given_name, name));
      }
      if (value.is_boolean()) {
        options.erase(name);
        if (value.boolean()) options[name] = {};
      } else {
        options[name] = texts(value, name);
      }
    }
  }

  std::vector<std::string> texts(const Json& value, const std::string& key) const {
    std::vector<std::string> result;
    if (!value.is_array()) return {text(value, key)};
    for (const Json& element : value.elements()) result.push_back(text(element, key));
    return result;
  }

  std::string text(const Json& value, const std::string& key) const {
    if (value.is_text()) return value.text();
    if (value.is_number()) return json_to_text(value);
    fail(fmt::format("\"{}\" is neither text nor a number", key));
  }

  double length(const Json& value, const std::string& key) const {
    if (value.is_number() && value.number() >= 0 && std::isfinite(value.number())) {
      return value.number();
    }
    fail(fmt::format("\"{}\" is not a length: give a number of at least 0", key));
  }

  FileSystem& files_;
  std::string path_;
  std::filesystem::path folder_;
  std::string where_;
};

/// Names become names of files, so each has to be one, and its own; inputs are files.
void check_jobs(const std::vector<Job>& jobs) {
  std::map<std::string, std::string> input_of_name;
  for (const Job& job : jobs) {
    if (std::find(job.inputs.begin(), job.inputs.end(), "-") != job.inputs.end()) {
      throw UsageError(
          fmt::format("{}: a job of a batch cannot read standard input: name a file", job.name));
    }
    if (job.name.empty() || job.name.starts_with('.') || job.name.find('/') != std::string::npos) {
      throw Failure(fmt::format("\"{}\" cannot be the name of a job: its files are named after it",
                                job.name));
    }
    const auto [known, is_new] = input_of_name.try_emplace(job.name, job.inputs.front());
    if (!is_new) {
      throw UsageError(fmt::format(
          "two jobs are called {}, one of {} and one of {}: their files would have the "
          "same names; leave one out, or give them names of their own in a list of jobs",
          job.name, known->second, job.inputs.front()));
    }
  }
}

}  // namespace

bool is_job_list(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == "json" || extension == "toml";
}

std::vector<Job> read_job_list(FileSystem& files, const std::string& path,
                               const std::vector<std::string>& to, const JobOptions& options) {
  std::vector<Job> jobs = ListReader(files, path).read(to, options);
  check_jobs(jobs);
  return jobs;
}

std::vector<Job> jobs_of_files(const std::vector<std::string>& files,
                               const std::vector<std::string>& to, const JobOptions& options) {
  std::vector<Job> jobs;
  jobs.reserve(files.size());
  for (const std::string& file : files) {
    jobs.push_back({.name = std::filesystem::path(file).stem().string(),
                    .inputs = {file},
                    .to = to,
                    .options = options});
  }
  check_jobs(jobs);
  return jobs;
}

}  // namespace spillway::command
