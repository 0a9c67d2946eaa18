#include <fmt/format.h>
#include <spillway/input.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <deque>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/disk/scratch_folder.h"
#include "formats/disk/unfinished_files.h"
#include "src/distributed/ranks.h"
#include "src/parallel/parallel.h"
#include "src/runtime/memory_budget.h"
#include "stream/library/resumable_run.h"
#include "tools/batch/child_process.h"
#include "tools/batch/job_buffers.h"
#include "tools/batch/job_folder.h"
#include "tools/batch/job_log.h"
#include "tools/batch/job_record.h"
#include "tools/batch/job_steps.h"
#include "tools/commands/command.h"
#include "tools/commands/run_statistics.h"
#include "tools/options/command_options.h"
#include "tools/process/failure.h"
#include "tools/process/interrupts.h"
#include "tools/report/json_text.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spillway batch 'tiles/*.laz' --output-dir meshes --to ply\n"
    "  spillway batch 'tiles/*.laz' --output-dir out --to spm,dem.tif --keep-class 2 --resolution "
    "1\n"
    "  spillway batch jobs.toml --output-dir out -j 4 --memory 8G --resume\n"
    "Each job has a log, NAME.log, and a record, NAME.status.json, beside its outputs. A failed "
    "one\n"
    "does not stop the others. docs/batch.md describes lists of jobs.";

/// A job needs so much memory to be worth starting.
constexpr std::uint64_t kLeastMemory = std::uint64_t{128} << 20;

constexpr double kMostBuffer = 1e9;

struct BatchOptions {
  std::vector<std::string> sources;
  std::string folder;
  std::vector<std::string> to;
  unsigned at_a_time = 0;
  unsigned threads = 0;
  bool resume = false;
  std::string checkpoint_seconds = "60";
  std::optional<double> buffer;
  MemoryOptions memory;
  ReportOptions report;
  /// The options for the jobs' steps, as batch's own parser has them.
  std::map<std::string, std::vector<std::string>> passed_values;
  std::map<std::string, bool> passed_flags;

  [[nodiscard]] JobOptions passed_on() const {
    JobOptions options;
    for (const auto& [name, values] : passed_values) {
      if (!values.empty()) options[name] = values;
    }
    for (const auto& [name, given] : passed_flags) {
      if (given) options[name] = {};
    }
    return options;
  }
};

/// What an option means to a job, where that is not what it means to a subcommand.
std::string meaning_in_jobs(const OptionInfo& option) {
  const std::string& flag = option.names.back();
  if (flag == "--bounds")
    return "Box that rasters cover; in jobs without rasters, that of points to use";
  if (flag == "--resolution") {
    return "Pixel size of rasters; in jobs without rasters, as in triangulate";
  }
  return option.description;
}

/// Takes every option of the subcommands that make outputs, those apart that batch decides on.
void add_options_of_subcommands(const CommandLine& root, CommandLine& app, BatchOptions& options) {
  for (const std::string& subcommand : job_subcommands()) {
    for (const OptionInfo& option : root.subcommand(subcommand).options()) {
      const std::string& flag = option.names.back();
      if (!flag.starts_with("--")) continue;
      const std::string name = flag.substr(2);
      const bool own = name == "help" || name == "output" || name == "stats" || name == "tasks" ||
                       name == "resume" || name == "checkpoint-every" ||
                       name.starts_with("simulate-") || name == "output-format";
      if (own || app.has_option(flag)) continue;
      const std::string group = "Passed on to the jobs";
      if (option.value_name.empty()) {
        app.add_flag(flag, options.passed_flags[name], meaning_in_jobs(option)).group(group);
      } else {
        app.add_option(flag, options.passed_values[name], meaning_in_jobs(option))
            .once()
            .value_name(option.value_name)
            .group(group);
      }
    }
  }
}

/// A folder for what only serves the jobs, below that of `options`.
std::string make_scratch(const MemoryOptions& options) {
  try {
    return make_temporary_folder(scratch_parent(options.scratch_parent), "spillway-batch-");
  } catch (const Failure& error) {
    throw SystemRefusal(error.what(), error.facts().file, 0, Remedy::kScratchFolder);
  }
}

/// Makes the folder of the outputs. Throws Failure if that cannot be done, or nothing can be written
/// there.
void make_output_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw Failure(fmt::format("--output-dir: cannot create the folder {}: {}; choose another one",
                              folder, error.message()));
  }
  if (::access((folder + "/.").c_str(), W_OK | X_OK) != 0) {
    throw Failure(fmt::format(
        "--output-dir: cannot write to {}: {}; choose another folder, or change its permissions",
        folder, std::generic_category().message(errno)));
  }
}

class Batch {
 public:
  Batch(const CommandLine& root, const BatchOptions& options)
      : root_(root),
        options_(options),
        progress_(make_progress(options.report)),
        free_threads_(
            static_cast<int>(options.threads == 0 ? available_threads() : options.threads)),
        free_memory_(memory_limit(options.memory)),
        temporary_(make_scratch(options.memory)) {}

  ~Batch() {
    children_.stop();
    remove_temporary_folder(temporary_);
  }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  int run() {
    const auto start = Clock::now();
    check_figures_file(options_.report, options_.sources, "", "the outputs");
    distributed::forget_launch();  // each job is a process on its own
    prepare();
    progress_.begin("batch", "jobs");
    while (!waiting_.empty() || !running_.empty()) {
      while (next_can_start()) start_next();
      if (!running_.empty()) finish_step(children_.wait_for_any());
      progress_.update(ended_, static_cast<double>(ended_) / static_cast<double>(runs_.size()));
    }
    progress_.end(ended_);
    return summarize(start);
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// A job whose steps are being done, and what it holds of the common budget.
  struct Running {
    JobRun* run = nullptr;
    std::shared_ptr<JobLog> log;  ///< null if it could not be made
    std::size_t step = 0;
    int threads = 1;
    std::uint64_t memory = 0;
    Clock::time_point start;
  };

  /// Plans all jobs, so that a wrong word anywhere is told before any work.
  void prepare() {
    const JobPlanner planner(root_, options_.folder, temporary_);
    const auto base = std::filesystem::path(options_.folder);
    std::vector<Job> jobs = all_jobs();
    for (const Job& job : jobs) {
      for (const JobStep& step : planner.plan(job)) check_command_line(step.arguments);
    }
    add_buffers(jobs,
                Context({.memory = fmt::format("{}", free_memory_),
                         .threads = static_cast<unsigned>(free_threads_),
                         .scratch_folder = temporary_}),
                [this](const std::string& text) { progress_.say(text); });
    for (Job& job : jobs) {
      JobRun run;
      run.steps = planner.plan(job);
      run.log = base / (job.name + ".log");
      run.record = base / (job.name + ".status.json");
      run.job = std::move(job);
      runs_.push_back(std::move(run));
    }
    make_output_folder(options_.folder);
    if (options_.resume) remove_unfinished_records(options_.folder, runs_);
    for (JobRun& run : runs_) {
      if (options_.resume && is_complete_and_unchanged(run)) {
        run.status = "unchanged";
        ++ended_;
      } else {
        run.resume_folder = resume_folder(run.job, run.steps.front());
        if (options_.resume) run.memory = memory_to_go_on_with(run).value_or(0);
        waiting_.push_back(&run);
      }
    }
    // What had begun gets its memory again before others take theirs.
    std::stable_partition(waiting_.begin(), waiting_.end(),
                          [](const JobRun* run) { return run->memory > 0; });
    limit_ = options_.at_a_time == 0 ? static_cast<unsigned>(free_threads_) : options_.at_a_time;
    limit_ =
        std::min<std::uint64_t>(limit_, std::max<std::uint64_t>(1, free_memory_ / kLeastMemory));
  }

  [[nodiscard]] std::vector<Job> all_jobs() {
    std::vector<Job> jobs = jobs_as_listed();
    if (options_.buffer) {
      for (Job& job : jobs) job.buffer = options_.buffer;
    }
    return jobs;
  }

  [[nodiscard]] std::vector<Job> jobs_as_listed() {
    const auto passed_on = options_.passed_on();
    if (options_.sources.size() == 1 && is_job_list(options_.sources.front())) {
      return read_job_list(disk(), options_.sources.front(), options_.to, passed_on);
    }
    if (options_.to.empty()) throw UsageError("--to is missing: it names the outputs, like ply");
    const Context context({.warning = [this](std::string_view text) { progress_.say(text); }});
    return jobs_of_files(expand_inputs(options_.sources, context), options_.to, passed_on);
  }

  [[nodiscard]] std::size_t at_a_time() const {
    return std::min<std::uint64_t>(limit_, running_.size() + waiting_.size());
  }

  [[nodiscard]] bool next_can_start() const {
    if (waiting_.empty() || running_.size() >= at_a_time()) return false;
    if (running_.empty()) return true;
    const std::uint64_t had = waiting_.front()->memory;
    return had > 0 ? had <= free_memory_ : free_memory_ / free_shares() >= kLeastMemory;
  }

  /// Jobs that could be started now.
  [[nodiscard]] std::size_t free_shares() const { return at_a_time() - running_.size(); }

  /// Gives the next job its share of what is free: as much as leaves the same for each that could
  /// be started now, or what it had before, if it goes on.
  void start_next() {
    const std::size_t shares = free_shares();
    Running job;
    job.run = waiting_.front();
    waiting_.pop_front();
    job.threads = std::max(1, free_threads_ / static_cast<int>(shares));
    const bool goes_on = job.run->memory > 0 && job.run->memory <= free_memory_;
    job.memory = goes_on ? job.run->memory : free_memory_ / shares;
    free_threads_ -= job.threads;
    free_memory_ -= job.memory;
    job.start = Clock::now();
    job.run->status = "running";
    try {
      job.run->inputs = input_fingerprints(job.run->job);
      if (std::filesystem::exists(job.run->resume_folder)) take_folder(*job.run, goes_on);
      job.run->memory = job.memory;
      if (keeps_checkpoints(*job.run)) save_record(*job.run);
      job.log = std::make_shared<JobLog>(job.run->log);
      start_step(job);
    } catch (const std::exception& error) {
      finish_job(job, words_of(error));
    }
  }

  /// Whether a job goes on in the midst when this batch was killed.
  [[nodiscard]] bool keeps_checkpoints(const JobRun& run) const {
    return options_.resume && !run.resume_folder.empty();
  }

  /// Of a job that has left a folder: it goes on with that, or begins again without it.
  void take_folder(JobRun& run, bool goes_on) {
    wait_until_unused(run.resume_folder);
    if (goes_on) {
      progress_.say(fmt::format("{}: goes on with {}", run.job.name, run.resume_folder));
      return;
    }
    discard_run(run.resume_folder, run.steps.front().output);
    const std::uint64_t had = std::exchange(run.memory, 0);  // no longer to go on with
    progress_.say(fmt::format(
        "{}: begins again, {}", run.job.name,
        !options_.resume ? "as --resume is not given"
        : had > 0 ? fmt::format("as it had {} of memory, more than there is", memory_size_text(had))
                  : "as its options, its inputs or the version are other ones than before, or "
                    "nothing is recorded of it"));
  }

  void start_step(const Running& job) {
    std::vector<std::string> arguments = job.run->steps[job.step].arguments;
    const CommandLine& subcommand = root_.subcommand(arguments.front());
    const auto add = [&](const std::string& option, const std::string& value) {
      if (subcommand.has_option("--" + option)) {
        arguments.push_back(fmt::format("--{}={}", option, value));
      }
    };
    add("threads", std::to_string(job.threads));
    add("memory", std::to_string(job.memory));
    if (const std::string& cap = options_.memory.scratch_cap; !cap.empty()) {
      add("max-tmp", std::to_string(parse_memory_size(cap) / limit_));
    }
    add("scratch-folder", temporary_);
    add("progress", "none");
    const bool can_go_on = job.step == 0 && keeps_checkpoints(*job.run);
    if (can_go_on) {
      add("resume", job.run->resume_folder);
      add("checkpoint-every", options_.checkpoint_seconds);
    }
    const std::string output = can_go_on ? "" : job.run->steps[job.step].output;
    running_[children_.start(arguments, output, job.log->descriptor())] = job;
  }

  void finish_step(const ChildEnd& end) {
    const auto found = running_.find(end.id);
    if (found == running_.end()) return;
    Running job = found->second;
    running_.erase(found);
    if (end.exit_code != kExitDone) {
      finish_job(job, reason_of(*job.log, end.exit_code));
    } else if (++job.step == job.run->steps.size()) {
      finish_job(job, "");
    } else {
      try {
        start_step(job);
      } catch (const std::exception& error) {
        finish_job(job, words_of(error));
      }
    }
  }

  /// `error` is empty if all went well.
  void finish_job(const Running& job, const std::string& error) {
    free_threads_ += job.threads;
    free_memory_ += job.memory;
    JobRun& run = *job.run;
    run.seconds = std::chrono::duration<double>(Clock::now() - job.start).count();
    run.status = error.empty() ? "done" : "failed";
    run.error = error;
    std::error_code ignored;  // the whole folder is removed at the end
    for (const JobStep& step : run.steps) {
      if (step.temporary) std::filesystem::remove(step.output, ignored);
    }
    try {
      save_record(run);
    } catch (const std::exception& failure) {
      run.status = "failed";
      run.error = words_of(failure);
    }
    ++ended_;
    progress_.say(fmt::format("[{}/{}] {}: {} in {:.1f} s{}", ended_, runs_.size(), run.job.name,
                              run.status, run.seconds, run.error.empty() ? "" : ": " + run.error));
  }

  static std::string reason_of(const JobLog& log, int exit_code) {
    if (exit_code > 128) return fmt::format("ended by signal {}", exit_code - 128);
    const std::string last = log.last_line();
    return last.empty() ? fmt::format("ended with exit code {}", exit_code) : last;
  }

  [[nodiscard]] std::size_t count(std::string_view status) const {
    return static_cast<std::size_t>(std::count_if(
        runs_.begin(), runs_.end(), [&](const JobRun& run) { return run.status == status; }));
  }

  int summarize(Clock::time_point start) {
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const std::size_t failed = count("failed");
    Json jobs = Json::array();
    for (const JobRun& run : runs_) {
      jobs.push_back({{"name", run.job.name},
                      {"status", run.status},
                      {"log", run.log},
                      {"record", run.record}});
    }
    write_figures(options_.report,
                  {{"done", count("done")},
                   {"failed", failed},
                   {"unchanged", count("unchanged")},
                   {"jobs", jobs}},
                  start);
    progress_.say(fmt::format("{} job{}: {} done, {} failed, {} unchanged, {:.1f} s", runs_.size(),
                              runs_.size() == 1 ? "" : "s", count("done"), failed,
                              count("unchanged"), seconds));
    for (const JobRun& run : runs_) {
      if (run.status == "failed") {
        progress_.insist(fmt::format("failed: {} ({})", run.job.name, run.log));
      }
    }
    return failed == 0 ? kExitDone : kExitFailed;
  }

  const CommandLine& root_;
  const BatchOptions& options_;
  ProgressLine progress_;
  std::vector<JobRun> runs_;
  std::deque<JobRun*> waiting_;
  std::map<pid_t, Running> running_;
  std::uint64_t limit_ = 1;  ///< jobs at a time
  int free_threads_;         ///< below 0 with more jobs than threads
  std::uint64_t free_memory_;
  std::size_t ended_ = 0;
  std::string temporary_;  ///< has what jobs leave there that are killed
  ChildProcesses children_;
  const InterruptAction interrupt_{[this] { children_.stop(); }};
};

}  // namespace

Subcommand add_batch(CommandLine& root) {
  const auto options = std::make_shared<BatchOptions>();
  CommandLine& app =
      root.add_subcommand("batch", "Do many jobs, one after the other or side by side");
  app.set_footer(kExamples);
  app.add_option("JOBS", options->sources,
                 "A list of jobs (.json, .toml), or point files, globs, folders: a job each")
      .required();
  app.add_option("--output-dir", options->folder, "Where outputs, logs and records go")
      .required()
      .value_name("DIR");
  app.add_option("--to", options->to, "Outputs of each job, like ply,dem.tif,hillshade.tif")
      .one_argument()
      .commas_separate()
      .value_name("KIND,...");
  take_whole_number(
      app.add_option("-j,--jobs", options->at_a_time, "Most jobs at a time; 0: one a thread"), 0,
      kMostThreads)
      .value_name("N")
      .show_default();
  take_number_between(app.add_option("--buffer", options->buffer,
                                     "Also read points of other jobs within M of a job's own"),
                      0, kMostBuffer)
      .value_name("M");
  app.add_flag(
      "--resume", options->resume,
      "Leave out jobs that are complete and unchanged, and go on with those that had begun");
  take_whole_number(app.add_option("--threads", options->threads,
                                   "Threads of all jobs together; 0: all there are"),
                    0, kMostThreads)
      .value_name("N")
      .group(kResourceGroup)
      .show_default();
  add_memory_options(app, options->memory);
  take_number_between(app.add_option("--checkpoint-every", options->checkpoint_seconds,
                                     "Seconds between two states that --resume keeps of a job"),
                      0, 1e6)
      .value_name("S")
      .group(kResourceGroup)
      .show_default();
  add_report_options(app, options->report);
  add_options_of_subcommands(root, app, *options);
  const auto run = [options, &root, &app] {
    if (!options->resume) refuse_given(app, {"--checkpoint-every"}, "without --resume");
    return Batch(root, *options).run();
  };
  return {&app, run};
}

}  // namespace spillway::command
