#include "tools/process/rank_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>

#include "formats/bytes/bytes.h"
#include "formats/disk/unfinished_files.h"
#include "stream/ranks/rank_executor.h"
#include "tools/report/advice.h"
#include "tools/report/printable_text.h"
#include "tools/report/standard_error.h"
#include "tools/report/usage_error.h"

namespace spillway::command {
namespace {

using distributed::launch;

std::optional<distributed::Ranks>& joined() {
  static std::optional<distributed::Ranks> ranks;
  return ranks;
}

/// How long a rank waits for the end of the job that a lower one brings about: a fault that all see
/// at the same time, such as a full disk, is to be reported once.
constexpr std::chrono::milliseconds kTurn{200};
constexpr std::chrono::milliseconds kFirstTurn{2000};
constexpr std::chrono::milliseconds kFirstJoinedTurn{800};
constexpr int kMostTurns = 50;

/// Options that may differ from rank to rank: what they have on their machines.
bool is_of_the_machine(std::string_view line) {
  constexpr std::array<std::string_view, 8> kOwn = {
      "memory", "scratch-folder", "max-tmp", "threads", "progress", "quiet", "verbose", "stats"};
  const std::string_view name = line.substr(0, line.find('='));
  return std::find(kOwn.begin(), kOwn.end(), name) != kOwn.end();
}

}  // namespace

const distributed::Ranks* join_ranks() {
  if (!launch().as_ranks) return nullptr;
  if (!joined()) joined() = distributed::Ranks::all();
  return &*joined();
}

std::shared_ptr<Executor> rank_executor() {
  const distributed::Ranks* const ranks = join_ranks();
  return ranks == nullptr ? nullptr : make_rank_executor(*ranks);
}

void check_same_options(const std::string& options) {
  const distributed::Ranks& ranks = *join_ranks();
  std::string common;
  std::istringstream lines(options);
  for (std::string line; std::getline(lines, line);) {
    if (!is_of_the_machine(line)) common += line + '\n';
  }
  const auto all = ranks.gather(as_bytes_of(common));
  for (std::size_t rank = 1; rank < all.size(); ++rank) {
    if (all[rank] == all[0]) continue;
    if (!is_first_rank()) ranks.barrier();  // never left: rank 0 ends the job
    throw UsageError(fmt::format(
        "rank {} was given other options than rank 0: only --scratch-folder, --max-tmp, --memory, "
        "--threads and those of reports may differ",
        rank));
  }
}

void leave_ranks() { joined().reset(); }

bool is_first_rank() { return (joined() ? joined()->rank() : launch().rank) == 0; }

int report_error(const Failure& error, int exit_code) {
  stop_if_run_is_ending();
  const std::string rank =
      joined() && joined()->size() > 1 ? fmt::format("rank {}: ", joined()->rank()) : "";
  // The first process to end with an error ends them all, but not as fast.
  const int turn = joined() ? joined()->rank() : launch().rank;
  if (turn > 0) std::this_thread::sleep_for(joined() ? kFirstJoinedTurn : kFirstTurn);
  std::this_thread::sleep_for(kTurn * std::min(turn, kMostTurns));
  if (const auto* const list = dynamic_cast<const ErrorList*>(&error)) {
    write_error(rank + list->heading() + ":");
    for (const Failure& fault : list->faults()) {
      write_to_standard_error("  " + printable(advised_message(fault)) + "\n");
    }
  } else {
    write_error(rank + advised_message(error));
  }
  return end_quietly(exit_code);
}

int end_quietly(int exit_code) {
  if (!joined()) return exit_code;
  remove_unfinished_files();
  distributed::abort_job(exit_code);
}

}  // namespace spillway::command
