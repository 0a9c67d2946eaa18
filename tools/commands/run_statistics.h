#pragma once
// --stats of all subcommands, and --tasks of those that triangulate points.

#include <spillway/triangulate.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/bytes/json.h"
#include "tools/options/triangulation_options.h"
#include "tools/report/statistics.h"
#include "tools/simulate/run_recorder.h"

namespace spillway::command {

/// Throws UsageError if --stats would go where an input is, or where the output goes, which messages
/// call `product`, and Failure if its file cannot be made.
void check_figures_file(const ReportOptions& options, const std::vector<std::string>& inputs,
                        const std::string& output, std::string_view product);

/// Writes the file of --stats, if it is asked for: `figures`, behind what all have in common, the
/// version, and before what they end with, the memory and the seconds since `start`.
void write_figures(const ReportOptions& options, const Json& figures,
                   std::chrono::steady_clock::time_point start);

/// Throws UsageError if --stats or --tasks would go where the other or the run's output goes, which
/// messages call `product`, or if --tasks is given to one of several ranks, and Failure if a file of
/// theirs cannot be made.
void check_statistics_file(const TriangulationOptions& options, const std::string& output,
                           std::string_view product);

/// A run that also writes the file of --tasks, if it is asked for, and tells the recorder, if there
/// is one, what it does. `run` triangulates with the options that it is given.
TracedReport trace_run(const TriangulationOptions& options, TriangulateOptions how,
                       const std::function<Report(const TriangulateOptions& how)>& run,
                       std::optional<RunRecorder>* recorder = nullptr);

/// triangulate() as such a run.
TracedReport triangulate_and_trace(const TriangulationOptions& options, PointSource& points,
                                   MeshSink& sink, TriangulateOptions how, const Context& context,
                                   std::optional<RunRecorder>* recorder = nullptr);

/// What there is to tell of a run that began at `start` and has just ended.
RunFacts facts_of_run(const TriangulationOptions& options, const std::string& output,
                      const Context& context, std::chrono::steady_clock::time_point start);

/// Writes the file of --stats, if it is asked for: the report, and what `product` has besides.
void write_statistics(const TriangulationOptions& options, const TracedReport& report,
                      const RunFacts& facts, const Json& product = Json::object());

}  // namespace spillway::command
