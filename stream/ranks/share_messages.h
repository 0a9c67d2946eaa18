#pragma once
// Shares of what ranks derive from a mesh, as messages between them.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "src/distributed/ranks.h"
#include "stream/sinks/mesh_shares.h"

namespace spillway::ranks {

/// From this rank to rank 0.
class ShareToFirstRank final : public ShareSender {
 public:
  /// `ranks` must outlive it.
  explicit ShareToFirstRank(const distributed::Ranks& ranks) : ranks_(ranks) {}

  [[nodiscard]] std::size_t message_bytes() const override;
  void send(std::span<const std::byte> message) override;
  /// Tells that this was all.
  void end();

 private:
  const distributed::Ranks& ranks_;
};

/// At rank 0, from all others.
class SharesOfOtherRanks final : public OtherShares {
 public:
  /// `ranks` must outlive it.
  explicit SharesOfOtherRanks(const distributed::Ranks& ranks);

  [[nodiscard]] std::size_t count() const override { return has_ended_.size(); }
  std::optional<std::vector<std::byte>> next(std::size_t other) override;
  /// Takes what nobody has asked for: what a rank sends afterwards is for others.
  void end();

 private:
  const distributed::Ranks& ranks_;
  std::vector<bool> has_ended_;
};

}  // namespace spillway::ranks
