#include "stream/ranks/share_messages.h"

#include <utility>

namespace spillway::ranks {
namespace {

/// Of the messages that rank 0 has at a time, of all ranks together.
constexpr std::size_t kBytesOfAllRanks = std::size_t{16} << 20;

}  // namespace

std::size_t ShareToFirstRank::message_bytes() const {
  return kBytesOfAllRanks / static_cast<std::size_t>(ranks_.size());
}

void ShareToFirstRank::send(std::span<const std::byte> message) { ranks_.send(0, message); }

void ShareToFirstRank::end() { ranks_.send(0, {}); }

SharesOfOtherRanks::SharesOfOtherRanks(const distributed::Ranks& ranks)
    : ranks_(ranks), has_ended_(static_cast<std::size_t>(ranks.size()) - 1) {}

std::optional<std::vector<std::byte>> SharesOfOtherRanks::next(std::size_t other) {
  if (has_ended_[other]) return std::nullopt;
  std::vector<std::byte> message = ranks_.receive(static_cast<int>(other) + 1);
  if (!message.empty()) return message;
  has_ended_[other] = true;
  return std::nullopt;
}

void SharesOfOtherRanks::end() {
  for (std::size_t other = 0; other < count(); ++other) {
    while (next(other)) {
    }
  }
}

}  // namespace spillway::ranks
