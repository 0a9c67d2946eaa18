#include "tests/benchmark/rank_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace spillway::detail {
namespace {

constexpr double kPaperSpeedUp = 260;  ///< Funke and Sanders 2017, uniform points in space
constexpr int kPaperRanks = 2048;
constexpr double kPaperPoints = 1e6;  ///< of a rank

/// What the model is made of. Border simplices count on both sides of a merge.
struct Figures {
  double point_seconds = 0;        ///< of one core
  double imbalance = 0;            ///< points of the largest rank over the mean
  double exchange_seconds = 0;     ///< of each point of a rank
  double exchange_bytes = 0;       ///< of a point that moves
  double messages_per_point = 0;   ///< of a rank to each other, by the rank's points
  std::vector<double> borders;     ///< simplices over N^((D - 1) / D), the root's first
  double merge_seconds = 0;        ///< of a border simplex
  double merge_bytes_sent = 0;     ///< likewise
  double merge_memory = 0;         ///< likewise
  double start_mib = 0;            ///< of a process that has done nothing
  double tiles_mib = 0;            ///< of a rank that merges nothing
  bool sees_merge_memory = false;  ///< whether merges took more than tiles
};

Figures figures_of(const std::vector<RankRun>& runs) {
  const RankRun& alone = runs.front();
  const RankRun& many = runs.back();
  const RankRun& few = runs[1];
  const MergeLevel& root = many.levels.back();
  Figures figures;
  figures.point_seconds = alone.cpu_seconds / alone.points;
  figures.imbalance = many.imbalance;
  figures.exchange_seconds = few.exchange_seconds / few.points;
  figures.exchange_bytes = many.point_bytes_sent / many.points_sent;
  figures.messages_per_point = many.messages / many.ranks / (many.points / many.ranks);
  for (auto level = many.levels.rbegin(); level != many.levels.rend(); ++level) {
    figures.borders.push_back(level->per_power(level->simplices, 3));
  }
  figures.merge_seconds = root.processor_seconds / root.simplices;
  figures.merge_bytes_sent = root.sent_bytes / root.simplices;
  figures.start_mib = many.start_peak_mib;
  figures.tiles_mib = *std::min_element(many.peaks_mib.begin(), many.peaks_mib.end());
  const double largest = *std::max_element(many.peaks_mib.begin(), many.peaks_mib.end());
  figures.sees_merge_memory = largest > 1.1 * figures.tiles_mib;
  figures.merge_memory = figures.sees_merge_memory
                             ? (largest - figures.start_mib) * kMiB / root.simplices
                             : many.waiting_bytes;
  return figures;
}

void print_figures(const Plan& plan, const std::vector<RankRun>& runs, const Figures& figures,
                   const Network& network) {
  const int most = runs.back().ranks;
  const std::string power = plan.dimension == 2 ? "N^(1/2)" : "N^(2/3)";
  std::string borders;
  for (const double border : figures.borders) {
    borders += fmt::format("{}{:.2f}", borders.empty() ? "" : ", ", border);
  }
  fmt::print("\n| figure of the model | value | measured with |\n|---|---|---|\n");
  const auto row = [](const std::string& figure, const std::string& value,
                      const std::string& source) {
    fmt::print("| {} | {} | {} |\n", figure, value, source);
  };
  const auto ranks = [](int number) {
    return fmt::format("{} rank{}", number, number == 1 ? "" : "s");
  };
  row("one core for a point, us", fmt::format("{:.3f}", 1e6 * figures.point_seconds),
      "1 rank, processor time without its start");
  row("points of the largest rank over the mean", fmt::format("{:.3f}", figures.imbalance),
      ranks(most));
  row("a rank to exchange a point, ns", fmt::format("{:.0f}", 1e9 * figures.exchange_seconds),
      ranks(runs[1].ranks) + ", waiting included");
  row("bytes of a point that moves", fmt::format("{:.2f}", figures.exchange_bytes), ranks(most));
  row("messages of a rank to each other, for a million points",
      fmt::format("{:.1f}", 1e6 * figures.messages_per_point), ranks(most));
  row("border simplices of a merge over " + power + ", from the root down", borders, ranks(most));
  row("merging a border simplex, ns", fmt::format("{:.0f}", 1e9 * figures.merge_seconds),
      ranks(most) + ", root");
  row("bytes sent for it", fmt::format("{:.1f}", figures.merge_bytes_sent), ranks(most) + ", root");
  row("memory for it, bytes", fmt::format("{:.0f}", figures.merge_memory),
      figures.sees_merge_memory ? ranks(most) + ", peak of the largest over a process' start"
                                : "of one that waits: merges took no more than tiles");
  row("a process' start, MiB", fmt::format("{:.0f}", figures.start_mib),
      ranks(most) + " of hardly any points");
  row("a rank that merges nothing, MiB", fmt::format("{:.0f}", figures.tiles_mib), ranks(most));
  row("network of a rank, GB/s", fmt::format("{:.1f}", network.bytes_per_second / 1e9),
      "assumed: there is none");
  row("a message, us", fmt::format("{:.1f}", 1e6 * network.latency), "assumed");
}

/// What P ranks of n points each take.
struct Estimate {
  double tiles = 0;
  double exchange = 0;
  double merges = 0;
  double largest_mib = 0;  ///< of the rank that merges at the root

  [[nodiscard]] double total() const { return tiles + exchange + merges; }
};

Estimate estimate(const Plan& plan, const Figures& figures, const Network& network, double n,
                  int ranks) {
  const double moved = n * (ranks - 1.0) / ranks;
  Estimate result;
  result.tiles = n * figures.point_seconds * figures.imbalance;
  result.exchange = n * figures.exchange_seconds +
                    moved * figures.exchange_bytes / network.bytes_per_second +
                    n * figures.messages_per_point * ranks * network.latency;
  double largest = 0;
  std::size_t depth = 0;
  for (int below = ranks; below >= 2; below /= 2, ++depth) {
    const double border = figures.borders[std::min(depth, figures.borders.size() - 1)] *
                          std::pow(below * n, (plan.dimension - 1.0) / plan.dimension);
    largest = std::max(largest, border);
    result.merges +=
        border * (figures.merge_seconds + figures.merge_bytes_sent / network.bytes_per_second) +
        network.latency;
  }
  const double memory_mib = static_cast<double>(plan.memory) / kMiB;
  const double tiles_mib =
      n > static_cast<double>(plan.points_per_rank) ? memory_mib : figures.tiles_mib;
  result.largest_mib =
      std::ceil(std::max(tiles_mib, figures.start_mib + largest * figures.merge_memory / kMiB));
  return result;
}

}  // namespace

void print_model(const Plan& plan, const std::vector<RankRun>& runs, const Network& network) {
  const Figures figures = figures_of(runs);
  print_figures(plan, runs, figures, network);
  const double memory_mib = static_cast<double>(plan.memory) / kMiB;
  fmt::print(
      "\n| points a rank | ranks | tiles s | exchange s | merges s | total s | efficiency | "
      "speed-up | largest rank, MiB of {:.0f} |\n|---|---|---|---|---|---|---|---|---|\n",
      memory_mib);
  for (const double n : {1e6, 1e8}) {
    for (int ranks = 2; ranks <= kPaperRanks; ranks *= 4) {
      const Estimate run = estimate(plan, figures, network, n, ranks);
      const double alone = n * figures.point_seconds;
      fmt::print(
          "| {:.0e} | {} | {:.2f} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.0f} | {:.0f}{} |\n", n,
          ranks, run.tiles, run.exchange, run.merges, run.total(), alone / run.total(),
          ranks * alone / run.total(), run.largest_mib,
          run.largest_mib > memory_mib ? ": too little" : "");
    }
  }
  const Estimate paper = estimate(plan, figures, network, kPaperPoints, kPaperRanks);
  fmt::print(
      "\nSpeed-up over one core at 2,048 ranks of a million points: {:.0f}; the paper's: {:.0f}.\n",
      kPaperRanks * kPaperPoints * figures.point_seconds / paper.total(), kPaperSpeedUp);
}

}  // namespace spillway::detail
