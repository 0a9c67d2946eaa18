#include "tests/benchmark/rank_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "stream/ranks/merges/gather_below.h"

namespace spillway::test {
namespace {

constexpr double kPaperSpeedUp = 260;  ///< Funke and Sanders 2017, uniform points in space
constexpr double kPaperMemory = 2.2;   ///< its growth for each core, from 1 to 2,048
constexpr int kPaperRanks = 2048;
constexpr double kPaperPoints = 1e6;  ///< of a rank

/// What every rank knows of each section of the stream, and of each rank's tiles: bytes.
constexpr double kSectionBytes = 48;
constexpr double kTilesBytes = 1000;

/// What the model is made of. Exposed simplices count on both sides of a merge.
struct Statistics {
  double point_seconds = 0;       ///< of one core
  double imbalance = 0;           ///< points of the largest rank over the mean
  double exchange_seconds = 0;    ///< of each point of a rank
  double exchange_bytes = 0;      ///< of a point that moves
  double messages_per_point = 0;  ///< of a rank to each other, by the rank's points
  std::vector<double> exposed;    ///< simplices of a merge over N^((D - 1) / D), the root's first
  std::vector<double> points;     ///< of its border, likewise
  double triangulation_seconds = 0;  ///< of a point of a border
  double share_seconds = 0;          ///< of an exposed simplex, all else
  double share_imbalance = 0;        ///< of the rank with most of that over the mean
  double inner_points = 0;           ///< of an inner border, over M^((D - 2) / (D - 1))
  double merge_bytes_sent = 0;       ///< of an exposed simplex
  double calls = 0;                  ///< of a merge whose border one rank triangulates
  double calls_of_inner = 0;         ///< more for each inner merge
  double start_mib = 0;              ///< of a process that has done nothing
  double rank_mib = 0;               ///< of the largest rank
};

/// The dimension of what is left of one of D dimensions, as a power of the number of points.
double power_of_border(int dimension) { return (dimension - 1.0) / dimension; }

std::size_t gather_below(int dimension) {
  return dimension == 2 ? kGatherBelow<2> : kGatherBelow<3>;
}

/// Calls each(points, ranks) for the inner merges that a rank takes part in while `workers` ranks
/// triangulate so many points: of two of them, of four, ..., of all.
void for_each_inner_merge(double points, int workers,
                          const std::function<void(double points, int ranks)>& each) {
  for (int ranks = 2; ranks <= workers; ranks *= 2) each(points * ranks / workers, ranks);
}

Statistics statistics_of(const Plan& plan, const std::vector<RankRun>& runs) {
  const RankRun& alone = runs.front();
  const RankRun& many = runs.back();
  const RankRun& few = runs[1];
  const MergeLevel& root = many.levels.back();
  Statistics statistics;
  statistics.point_seconds = alone.cpu_seconds / alone.points;
  statistics.imbalance = many.imbalance;
  statistics.exchange_seconds = few.exchange_seconds / few.points;
  statistics.exchange_bytes = many.point_bytes_sent / many.points_sent;
  statistics.messages_per_point = many.messages / many.ranks / (many.points / many.ranks);
  double seconds = 0;
  double points = 0;
  for (auto level = many.levels.rbegin(); level != many.levels.rend(); ++level) {
    statistics.exposed.push_back(level->per_power(level->exposed, plan.dimension));
    statistics.points.push_back(level->per_power(level->points, plan.dimension));
    seconds += level->triangulation_seconds * level->merges;
    points += level->points * level->merges;
  }
  statistics.triangulation_seconds = seconds / points;
  statistics.share_seconds = root.share_seconds / root.exposed;
  statistics.share_imbalance = root.longest_share_seconds / (root.share_seconds / many.ranks);
  statistics.merge_bytes_sent = root.sent_bytes / root.exposed;
  statistics.calls = many.levels.front().calls;
  if (root.inner_merges > 0) {
    double powers = 0;
    for_each_inner_merge(root.points, many.ranks / 2, [&](double below, int) {
      powers += std::pow(below, power_of_border(plan.dimension - 1));
    });
    statistics.inner_points = root.inner_points / powers;
    statistics.calls_of_inner = (root.calls - statistics.calls) / root.inner_merges;
  }
  statistics.start_mib = many.start_peak_mib;
  statistics.rank_mib = *std::max_element(many.peaks_mib.begin(), many.peaks_mib.end());
  return statistics;
}

void print_figures(const Plan& plan, const std::vector<RankRun>& runs, const Statistics& statistics,
                   const Network& network) {
  const int most = runs.back().ranks;
  const auto list = [](const std::vector<double>& values) {
    std::string text;
    for (const double value : values) {
      text += fmt::format("{}{:.2f}", text.empty() ? "" : ", ", value);
    }
    return text;
  };
  fmt::print("\n| figure of the model | value | measured with |\n|---|---|---|\n");
  const auto row = [](const std::string& figure, const std::string& value,
                      const std::string& source) {
    fmt::print("| {} | {} | {} |\n", figure, value, source);
  };
  const auto ranks = [](int number) {
    return fmt::format("{} rank{}", number, number == 1 ? "" : "s");
  };
  const std::string power = plan.dimension == 2 ? "N^(1/2)" : "N^(2/3)";
  const std::string inner_power = plan.dimension == 2 ? "1" : "M^(1/2)";
  row("one core for a point, us", fmt::format("{:.3f}", 1e6 * statistics.point_seconds),
      "1 rank, processor time without its start");
  row("points of the largest rank over the mean", fmt::format("{:.3f}", statistics.imbalance),
      ranks(most));
  row("a rank to exchange a point, ns", fmt::format("{:.0f}", 1e9 * statistics.exchange_seconds),
      ranks(runs[1].ranks) + ", waiting included");
  row("bytes of a point that moves", fmt::format("{:.2f}", statistics.exchange_bytes), ranks(most));
  row("messages of a rank to each other, for a million points",
      fmt::format("{:.1f}", 1e6 * statistics.messages_per_point), ranks(most));
  row("exposed simplices of a merge over " + power + ", from the root down",
      list(statistics.exposed), ranks(most));
  row("points that it triangulates again over " + power + ", from the root down",
      list(statistics.points), ranks(most));
  row("triangulating one of these points, ns",
      fmt::format("{:.0f}", 1e9 * statistics.triangulation_seconds), ranks(most) + ", all levels");
  row("all else for an exposed simplex, ns", fmt::format("{:.0f}", 1e9 * statistics.share_seconds),
      ranks(most) + ", root, all ranks together");
  row("of that the rank with most over the mean", fmt::format("{:.2f}", statistics.share_imbalance),
      ranks(most) + ", root");
  row("bytes sent for an exposed simplex", fmt::format("{:.1f}", statistics.merge_bytes_sent),
      ranks(most) + ", root");
  row("points of an inner merge's border over " + inner_power + " of the M points below it",
      statistics.inner_points > 0 ? fmt::format("{:.1f}", statistics.inner_points) : "none seen",
      statistics.inner_points > 0 ? ranks(most) + ", root"
                                  : "so the model has one rank do all of it");
  row("points of a border below which one rank triangulates it",
      fmt::format("{}", gather_below(plan.dimension)), "the command's own limit");
  row("calls of a merge; and more for each inner merge",
      fmt::format("{:.0f}; {:.0f}", statistics.calls, statistics.calls_of_inner),
      ranks(most) + ", level 1; root");
  row("a process' start, MiB", fmt::format("{:.0f}", statistics.start_mib),
      ranks(most) + " of hardly any points");
  row("the largest rank, MiB; one rank alone",
      fmt::format("{:.0f}; {:.0f}", statistics.rank_mib, runs.front().peaks_mib.front()),
      ranks(most) + "; 1 rank");
  row("network of a rank, GB/s", fmt::format("{:.1f}", network.bytes_per_second / 1e9),
      "assumed: there is none");
  row("a message, us", fmt::format("{:.1f}", 1e6 * network.latency), "assumed");
}

/// What P ranks of n points each take.
struct Estimate {
  double tiles = 0;
  double exchange = 0;
  double merges = 0;
  double largest_mib = 0;

  [[nodiscard]] double total() const { return tiles + exchange + merges; }
};

class Model {
 public:
  Model(const Plan& plan, const Statistics& statistics, const Network& network)
      : plan_(plan), statistics_(statistics), network_(network) {}

  /// What every rank knows of all others.
  [[nodiscard]] static double tables_mib(int ranks) {
    const double sections = 3.0 * ranks * std::log2(ranks);
    return (sections * kSectionBytes + ranks * kTilesBytes) / kMiB;
  }

  [[nodiscard]] Estimate estimate(double n, int ranks) const {
    const double moved = n * (ranks - 1.0) / ranks;
    Estimate result;
    result.tiles = n * statistics_.point_seconds * statistics_.imbalance;
    result.exchange = n * statistics_.exchange_seconds +
                      moved * statistics_.exchange_bytes / network_.bytes_per_second +
                      n * statistics_.messages_per_point * ranks * network_.latency;
    std::size_t depth = 0;
    for (int below = ranks; below >= 2; below /= 2, ++depth) {
      result.merges += merge_seconds(n, below, std::min(depth, statistics_.exposed.size() - 1));
    }
    const double tiles_mib = n > static_cast<double>(plan_.points_per_rank)
                                 ? static_cast<double>(plan_.memory) / kMiB
                                 : statistics_.rank_mib;
    result.largest_mib = std::ceil(tiles_mib + tables_mib(ranks));
    return result;
  }

 private:
  /// A merge of so many ranks, at a depth below the root.
  [[nodiscard]] double merge_seconds(double n, int ranks, std::size_t depth) const {
    const double power = std::pow(ranks * n, power_of_border(plan_.dimension));
    const double share = statistics_.exposed[depth] * power / ranks * statistics_.share_imbalance;
    return share * (statistics_.share_seconds +
                    statistics_.merge_bytes_sent / network_.bytes_per_second) +
           statistics_.calls * call_seconds(ranks) +
           triangulation_seconds(statistics_.points[depth] * power, ranks / 2, plan_.dimension - 1);
  }

  /// Of points that form a border of so many dimensions.
  [[nodiscard]] double triangulation_seconds(double points, int workers, int dimension) const {
    const double alone = points * statistics_.triangulation_seconds;
    const bool is_small = points < static_cast<double>(gather_below(plan_.dimension));
    if (workers < 2 || is_small || statistics_.inner_points == 0) return alone;
    double seconds = alone / workers;
    for_each_inner_merge(points, workers, [&](double below, int ranks) {
      const double border = statistics_.inner_points * std::pow(below, power_of_border(dimension));
      seconds += statistics_.calls_of_inner * call_seconds(ranks) +
                 triangulation_seconds(border, ranks / 2, std::max(1, dimension - 1));
    });
    return seconds;
  }

  /// Of what ranks do together.
  [[nodiscard]] double call_seconds(int ranks) const { return std::log2(ranks) * network_.latency; }

  const Plan& plan_;
  const Statistics& statistics_;
  const Network& network_;
};

}  // namespace

void print_model(const Plan& plan, const std::vector<RankRun>& runs, const Network& network) {
  const Statistics statistics = statistics_of(plan, runs);
  print_figures(plan, runs, statistics, network);
  const Model model(plan, statistics, network);
  fmt::print(
      "\n| points a rank | ranks | tiles s | exchange s | merges s | total s | efficiency | "
      "speed-up | largest rank, MiB |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const double n : {1e6, 1e8}) {
    for (int ranks = 2; ranks <= kPaperRanks; ranks *= 4) {
      const Estimate run = model.estimate(n, ranks);
      const double alone = n * statistics.point_seconds;
      fmt::print("| {:.0e} | {} | {:.2f} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.0f} | {:.0f} |\n",
                 n, ranks, run.tiles, run.exchange, run.merges, run.total(), alone / run.total(),
                 ranks * alone / run.total(), run.largest_mib);
    }
  }
  const Estimate paper = model.estimate(kPaperPoints, kPaperRanks);
  const double growth =
      (statistics.rank_mib + model.tables_mib(kPaperRanks)) / runs.front().peaks_mib.front();
  fmt::print(
      "\nAt 2,048 ranks of a million points: speed-up over one core {:.0f}, the paper's {:.0f}; "
      "memory of a rank {:.2f} times that of one, the paper's {:.1f}.\n",
      kPaperRanks * kPaperPoints * statistics.point_seconds / paper.total(), kPaperSpeedUp, growth,
      kPaperMemory);
}

}  // namespace spillway::test
