#include "tools/simulate/run_player.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "tools/simulate/machine.h"
#include "tools/simulate/tile_player.h"

namespace spillway::command {
namespace {

/// Plays batches of points on their way to the tiles, then the tiles that are left.
class RunPlayer {
 public:
  RunPlayer(const RunModel& run, const SimulatedCores& on)
      : run_(run),
        threads_(std::max(1U, std::min(on.cores, run.limits.threads))),
        machine_(threads_, on.disk_speed),
        tiles_(run, machine_, threads_),
        dealt_(run.batches.size()),
        encoded_(run.batches.size()) {}

  double play() {
    machine_.compute(run_.begin, Urgency::kInOrder, [this] {
      send_batches(run_.read_batches, [this] { tiles_.when_idle([this] { deal_again(); }); });
    });
    return machine_.run();
  }

 private:
  using Then = SimulatedMachine::Then;

  void deal_again() {
    send_batches(run_.batches.size(), [this] { work_off_rest(); });
  }

  void work_off_rest() {
    tiles_.add_until(static_cast<std::uint32_t>(run_.nodes.size()));
    tiles_.work_off_all([this] { machine_.compute(run_.end, Urgency::kInOrder, [] {}); });
  }

  /// Batches up to that one; calls `done` when all have arrived.
  void send_batches(std::size_t end, Then done) {
    end_ = end;
    all_arrived_ = std::move(done);
    if (next_write_ == end_) return all_arrived_();
    fetch();
  }

  void fetch() {
    if (fetching_ || next_fetch_ == end_) return;
    if (next_fetch_ - next_write_ >= std::max<std::uint64_t>(1, run_.limits.batches)) return;
    fetching_ = true;
    const std::size_t b = next_fetch_++;
    machine_.move(run_.batches[b].fetched_bytes, [this, b] {
      machine_.compute(run_.batches[b].fetch, Urgency::kInOrder, [this, b] {
        fetching_ = false;
        deal(b);
        fetch();
      });
    });
  }

  void deal(std::size_t b) {
    machine_.compute(run_.batches[b].deal, Urgency::kBatch, [this, b] {
      dealt_[b] = true;
      append();
    });
  }

  void append() {
    if (appending_ || next_append_ == end_ || !dealt_[next_append_]) return;
    appending_ = true;
    const std::size_t b = next_append_;
    machine_.compute(run_.batches[b].append, Urgency::kInOrder, [this, b] {
      appending_ = false;
      ++next_append_;
      encode(b);
      append();
    });
  }

  void encode(std::size_t b) {
    machine_.compute(run_.batches[b].encode, Urgency::kBatch, [this, b] {
      encoded_[b] = true;
      write();
    });
  }

  /// A batch keeps its turn until nothing is too much of what it has made ready.
  void write() {
    if (writing_ || next_write_ == end_ || !encoded_[next_write_]) return;
    writing_ = true;
    const BatchCost& batch = run_.batches[next_write_];
    machine_.move(batch.written_bytes, [this, &batch] {
      machine_.compute(batch.write, Urgency::kInOrder, [this] {
        const std::uint32_t end = nodes_after(next_write_ + 1);
        if (end == tiles_.added()) return written();
        tiles_.add_until(end);
        tiles_.work_ahead([this] { written(); });
      });
    });
  }

  void written() {
    writing_ = false;
    ++next_write_;
    fetch();
    write();
    if (next_write_ == end_ && all_arrived_) std::exchange(all_arrived_, {})();
  }

  /// The nodes that can be worked on after so many batches. What can be after all of them waits for
  /// the end.
  [[nodiscard]] std::uint32_t nodes_after(std::size_t batches) const {
    std::uint32_t end = tiles_.added();
    if (batches >= run_.read_batches) return end;
    while (end < run_.nodes.size() && run_.nodes[end].after_batches <= batches) ++end;
    return end;
  }

  const RunModel& run_;
  const unsigned threads_;
  SimulatedMachine machine_;
  TilePlayer tiles_;
  std::size_t end_ = 0;  ///< of the batches that are sent now
  Then all_arrived_{};
  std::size_t next_fetch_ = 0;
  std::size_t next_append_ = 0;
  std::size_t next_write_ = 0;
  bool fetching_ = false;
  bool appending_ = false;
  bool writing_ = false;
  std::vector<bool> dealt_;
  std::vector<bool> encoded_;
};

}  // namespace

double RunModel::total_seconds() const {
  double sum = begin + end;
  for (const BatchCost& batch : batches) {
    sum += batch.fetch + batch.deal + batch.append + batch.encode + batch.write;
  }
  for (const RunNode& node : nodes) {
    const NodeCost& cost = costs[node.cost];
    sum += cost.read + cost.decode + cost.arrange + cost.divide.total_seconds() + cost.finish;
    for (const PartCost& part : cost.parts) {
      sum += part.work.total_seconds() + part.settle + part.write;
    }
  }
  return sum;
}

double play(const RunModel& run, const SimulatedCores& on) { return RunPlayer(run, on).play(); }

}  // namespace spillway::command
