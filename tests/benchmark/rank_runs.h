#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/benchmark/child_process.h"

namespace spillway::test {

inline constexpr double kMiB = 1024.0 * 1024.0;

/// What is run.
struct Plan {
  std::string command = SPILLWAY_COMMAND;
  std::string mpirun = SPILLWAY_MPIRUN;
  std::string folder = ".";
  std::string family = "terrain";
  int dimension = 2;
  std::uint64_t points = 20'000'000;        ///< of the comparison with threads
  std::uint64_t points_per_rank = 500'000;  ///< of weak scaling and of the sweep
  std::vector<int> ranks{1, 2, 4, 8};
  std::vector<int> sweep{};           ///< products of ranks and threads
  std::uint64_t memory = 512U << 20;  ///< bytes of a process with one thread
  unsigned turns = 3;
};

/// Merges between ranks of one level, one being the lowest. Means over them.
struct MergeLevel {
  int level = 0;
  double merges = 0;
  double below = 0;         ///< points
  double simplices = 0;     ///< of the borders of both sides
  double exposed = 0;       ///< of these, that the other side may change
  double points = 0;        ///< of the border, which are triangulated again
  double inner_merges = 0;  ///< of a rank that has most of them
  double inner_points = 0;  ///< of the borders of these
  double sent_bytes = 0;    ///< by all ranks of a merge
  double calls = 0;         ///< of a rank that has most of them
  // In the turn that took least, processor time:
  double triangulation_seconds = 0;  ///< of all ranks of a merge, for the points
  double share_seconds = 0;          ///< likewise, for all else
  double longest_share_seconds = 0;  ///< of the rank that takes longest for all else
  double longest_seconds = 0;        ///< of the rank that takes longest

  /// Of a figure, by below^((D - 1) / D).
  [[nodiscard]] double per_power(double figure, int dimension) const;
};

/// What one number of ranks showed. Sizes are those of the last turn.
struct RankRun {
  int ranks = 0;
  double points = 0;             ///< of all ranks
  double cpu_seconds = 0;        ///< of all processes without their start, median
  double start_cpu_seconds = 0;  ///< of all processes for hardly any points
  double start_peak_mib = 0;     ///< of the largest process for hardly any points
  double exchange_seconds = 0;   ///< of all ranks together, in the turn that took least
  double points_sent = 0;
  double point_bytes_sent = 0;
  double messages = 0;             ///< with points, of the rank that sent most
  double imbalance = 0;            ///< points of the largest rank over the mean
  double waiting_bytes = 0;        ///< in memory, of a border simplex that waits for its merge
  std::vector<double> peaks_mib;   ///< of each rank
  std::vector<MergeLevel> levels;  ///< from the lowest to the root
};

double median(std::vector<double> values);

/// Writes the input of all runs.
void generate(const Plan& plan, std::uint64_t points);

/// Triangulates it by one process without mpirun.
ProcessFigures run_threads(const Plan& plan, int threads);

/// Triangulates it by ranks of as many threads, each with `plan.memory` for every thread.
ProcessFigures run_ranks(const Plan& plan, int ranks, int threads);

/// --stats of the last run.
nlohmann::json statistics(const Plan& plan);

/// Sum and maximum of a figure over ranks.
double sum(const nlohmann::json& each, const char* key);
double most(const nlohmann::json& each, const char* key);

/// Ranks of one thread, each with `plan.points_per_rank`.
RankRun measure(const Plan& plan, int ranks);

/// Removes the files of all runs.
void remove_files(const Plan& plan);

}  // namespace spillway::test
