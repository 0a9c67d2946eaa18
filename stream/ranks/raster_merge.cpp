#include "stream/ranks/raster_merge.h"

#include <utility>
#include <vector>

#include "src/distributed/packing.h"

namespace spillway::detail {
namespace {

using distributed::Packer;
using distributed::Ranks;
using distributed::Unpacker;

/// Bytes of tiles that a rank sends at a time, at least: rank 0 has as many of each rank.
std::size_t message_bytes(const Ranks& ranks) {
  constexpr std::size_t kOfAllRanks = std::size_t{16} << 20;
  return kOfAllRanks / static_cast<std::size_t>(ranks.size());
}

/// The tiles that come from one rank, in ascending order. The message that ends them is empty.
class Inbox {
 public:
  Inbox(const Ranks& ranks, int from) : ranks_(ranks), from_(from) {}

  /// Appends what the rank has of this tile, if anything.
  void take(std::uint64_t tile, std::vector<std::vector<std::byte>>& others) {
    while (!ended_ && next_ == tiles_.size()) receive();
    if (ended_ || tiles_[next_].first != tile) return;
    others.push_back(std::move(tiles_[next_++].second));
  }

  /// Receives the message that ends the tiles, which nobody has to ask for: what the rank sends
  /// afterwards is for others.
  void end() {
    while (!ended_) receive();
  }

 private:
  void receive() {
    const std::vector<std::byte> message = ranks_.receive(from_);
    tiles_.clear();
    next_ = 0;
    ended_ = message.empty();
    for (Unpacker unpacker(message); !unpacker.empty();) {
      const auto tile = unpacker.take<std::uint64_t>();
      tiles_.emplace_back(tile, unpacker.take_list<std::vector<std::byte>>());
    }
  }

  const Ranks& ranks_;
  int from_;
  bool ended_ = false;
  std::vector<std::pair<std::uint64_t, std::vector<std::byte>>> tiles_;
  std::size_t next_ = 0;
};

}  // namespace

void paint_merged(Dem& dem, const MergedSection& section) {
  std::vector<PlacedPoint> vertices = dem.placed(section.mesh.vertices);
  dem.count(vertices);
  const std::vector<PlacedPoint> imported = dem.placed(section.imported_vertices);
  vertices.insert(vertices.end(), imported.begin(), imported.end());
  dem.paint(vertices, section.mesh.corners);
}

void write_raster_of_ranks(Dem& dem, Raster& raster,
                           const std::function<void(std::uint64_t pixels)>& progress,
                           const Ranks& ranks) {
  std::vector<Inbox> inboxes;
  for (int rank = 1; rank < ranks.size(); ++rank) inboxes.emplace_back(ranks, rank);
  dem.write(raster, progress, [&](std::uint64_t tile) {
    std::vector<std::vector<std::byte>> others;
    for (Inbox& inbox : inboxes) inbox.take(tile, others);
    return others;
  });
  for (Inbox& inbox : inboxes) inbox.end();
}

void send_raster(Dem& dem, const Ranks& ranks) {
  Packer message;
  for (const std::uint64_t tile : dem.tiles()) {
    message.put(tile);
    message.put_list(dem.take_tile(tile));
    if (message.bytes().size() >= message_bytes(ranks)) ranks.send(0, message.take());
  }
  if (!message.bytes().empty()) ranks.send(0, message.take());
  ranks.send(0, {});
}

}  // namespace spillway::detail
