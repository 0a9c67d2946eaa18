#include "stream/sinks/dem_shares.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "src/runtime/packing.h"

namespace spillway::stream {
namespace {

/// The tiles that come from one process, in ascending order.
class TilesOfOther {
 public:
  TilesOfOther(OtherShares& shares, std::size_t other) : shares_(shares), other_(other) {}

  /// Appends what the other has of this tile, if anything.
  void take(std::uint64_t tile, std::vector<std::vector<std::byte>>& others) {
    while (!ended_ && next_ == tiles_.size()) receive();
    if (ended_ || tiles_[next_].first != tile) return;
    others.push_back(std::move(tiles_[next_++].second));
  }

 private:
  void receive() {
    const std::optional<std::vector<std::byte>> message = shares_.next(other_);
    tiles_.clear();
    next_ = 0;
    ended_ = !message;
    if (ended_) return;
    for (Unpacker unpacker(*message); !unpacker.empty();) {
      const auto tile = unpacker.take<std::uint64_t>();
      tiles_.emplace_back(tile, unpacker.take_list<std::vector<std::byte>>());
    }
  }

  OtherShares& shares_;
  std::size_t other_;
  bool ended_ = false;
  std::vector<std::pair<std::uint64_t, std::vector<std::byte>>> tiles_;
  std::size_t next_ = 0;
};

/// Points come before tiles, in messages of which the last one has none.
void give_points(PixelPoints& points, ShareSender& sender) {
  std::vector<PointInPixel> some;
  const std::size_t most = std::max<std::size_t>(1, sender.message_bytes() / sizeof(some[0]));
  const auto send = [&] {
    Packer message;
    message.put_list(some);
    sender.send(message.take());
    some.clear();
  };
  points.read_all([&](const PointInPixel& point) {
    some.push_back(point);
    if (some.size() == most) send();
  });
  if (!some.empty()) send();
  send();
}

void take_points(OtherShares& others, PixelPoints& points) {
  for (std::size_t other = 0; other < others.count(); ++other) {
    while (const std::optional<std::vector<std::byte>> message = others.next(other)) {
      const auto some = Unpacker(*message).take_list<std::vector<PointInPixel>>();
      if (some.empty()) break;
      points.add(some);
    }
  }
}

}  // namespace

void give_share(Dem& dem, ShareSender& sender) {
  if (dem.points() != nullptr) give_points(*dem.points(), sender);
  Packer message;
  for (const std::uint64_t tile : dem.tiles()) {
    message.put(tile);
    message.put_list(dem.take_tile(tile));
    if (message.bytes().size() >= sender.message_bytes()) sender.send(message.take());
  }
  if (!message.bytes().empty()) sender.send(message.take());
}

OtherTiles take_shares(OtherShares& others, Dem& dem) {
  if (others.count() == 0) return nullptr;
  if (dem.points() != nullptr) take_points(others, *dem.points());
  const auto inboxes = std::make_shared<std::vector<TilesOfOther>>();
  for (std::size_t other = 0; other < others.count(); ++other) inboxes->emplace_back(others, other);
  return [inboxes](std::uint64_t tile) {
    std::vector<std::vector<std::byte>> of_others;
    for (TilesOfOther& inbox : *inboxes) inbox.take(tile, of_others);
    return of_others;
  };
}

}  // namespace spillway::stream
