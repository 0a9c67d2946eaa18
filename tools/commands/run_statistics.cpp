#include "tools/commands/run_statistics.h"

#include <fmt/format.h>

#include "formats/disk/output_check.h"
#include "tools/process/rank_job.h"
#include "tools/report/json_text.h"
#include "tools/report/text_output.h"
#include "tools/report/usage_error.h"

namespace spillway::detail {

void check_statistics_file(const TriangulationOptions& options, const std::string& output,
                           std::string_view product) {
  if (options.stats_path.empty()) return;
  if (options.stats_path == output) {
    throw UsageError(
        fmt::format("{} and --stats cannot go to the same place: {}", product, output));
  }
  if (is_first_rank()) check_can_create(disk(), options.stats_path);
}

RunFacts facts_of_run(const TriangulationOptions& options, const std::string& output,
                      const Context& context, std::chrono::steady_clock::time_point start) {
  return {
      .inputs = options.inputs,
      .output = output,
      .memory_limit = context.memory(),
      .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

void write_statistics(const TriangulationOptions& options, const Report& report,
                      const RunFacts& facts, const Json& product) {
  if (options.stats_path.empty()) return;
  Json json = to_json(report, facts);
  for (const Json::Member& member : product.members()) json[member.name] = member.value;
  write_text(options.stats_path, json_text(json, 2) + "\n");
}

}  // namespace spillway::detail
