#include "tools/commands/run_statistics.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include "formats/disk/output_check.h"
#include "src/distributed/ranks.h"
#include "src/runtime/process_memory.h"
#include "tools/process/interrupts.h"
#include "tools/process/rank_job.h"
#include "tools/report/command_trace.h"
#include "tools/report/json_text.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

/// Throws UsageError if a file of `option` would go to the same place as `what`.
void check_place(const std::string& path, const std::string& other, std::string_view what,
                 std::string_view option) {
  std::error_code unknown;  // which is no file yet
  if (path.empty() || (path != other && !std::filesystem::equivalent(path, other, unknown))) return;
  throw UsageError(fmt::format("{} and {} cannot go to the same place: {}", what, option, path));
}

}  // namespace

void check_statistics_file(const TriangulationOptions& options, const std::string& output,
                           std::string_view product) {
  if (!options.tasks_path.empty() && distributed::launch().as_ranks) {
    throw UsageError("--tasks is for one process: start it without mpirun");
  }
  check_place(options.tasks_path, output, product, "--tasks");
  check_place(options.tasks_path, options.report.stats_path, "--stats", "--tasks");
  check_figures_file(options.report, options.inputs, output, product);
  if (!options.tasks_path.empty()) check_can_create(options.tasks_path);
}

void check_figures_file(const ReportOptions& options, const std::vector<std::string>& inputs,
                        const std::string& output, std::string_view product) {
  check_place(options.stats_path, output, product, "--stats");
  for (const std::string& input : inputs) {
    if (input != "-") check_place(options.stats_path, input, "an input", "--stats");
  }
  if (!options.stats_path.empty() && is_first_rank()) check_can_create(options.stats_path);
}

void write_figures(const ReportOptions& options, const Json& figures,
                   std::chrono::steady_clock::time_point start) {
  if (options.stats_path.empty()) return;
  Json json = {{"version", SPILLWAY_VERSION}};
  for (const Json::Member& member : figures.members()) json[member.name] = member.value;
  json["peak_rss_bytes"] = peak_memory();
  json["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_text(options.stats_path, json_text(json, 2) + "\n");
}

TracedReport trace_run(const TriangulationOptions& options, TriangulateOptions how,
                       const std::function<Report(const TriangulateOptions& how)>& run,
                       std::optional<RunRecorder>* recorder) {
  std::optional<InterruptAdvice> advice;
  if (!how.resume_folder.empty()) {
    advice.emplace(
        fmt::format("the same command goes on from the last checkpoint in {}, if there is one",
                    how.resume_folder));
  }
  const auto trace = std::make_shared<CommandTrace>(options.tasks_path, recorder);
  how.trace = trace;
  TracedReport report{run(how)};
  report.sums = trace->commit();
  return report;
}

TracedReport triangulate_and_trace(const TriangulationOptions& options, PointSource& points,
                                   MeshSink& sink, TriangulateOptions how, const Context& context,
                                   std::optional<RunRecorder>* recorder) {
  return trace_run(
      options, std::move(how),
      [&](const TriangulateOptions& traced) { return triangulate(points, sink, traced, context); },
      recorder);
}

RunFacts facts_of_run(const TriangulationOptions& options, const std::string& output,
                      const Context& context, std::chrono::steady_clock::time_point start) {
  return {
      .inputs = options.inputs,
      .output = output,
      .memory_limit = context.memory(),
      .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

void write_statistics(const TriangulationOptions& options, const TracedReport& report,
                      const RunFacts& facts, const Json& product) {
  if (options.report.stats_path.empty()) return;
  Json json = to_json(report, facts);
  for (const Json::Member& member : product.members()) json[member.name] = member.value;
  write_text(options.report.stats_path, json_text(json, 2) + "\n");
}

}  // namespace spillway::command
