#include "stream/sinks/contour_shares.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "src/runtime/packing.h"

namespace spillway::stream {
namespace {

/// What a message holds: its first byte.
enum class Content : std::uint8_t { kStatistics, kWholeLines, kOpenLines, kHullEdges };

Packer message_of(Content content) {
  Packer message;
  message.put(content);
  return message;
}

void give_open_lines(LineJoiner& joiner, ShareSender& sender) {
  Packer message = message_of(Content::kOpenLines);
  const std::size_t none = message.bytes().size();
  joiner.hand_over([&](const LineJoiner::OpenLine& line) {
    message.put(line.begin);
    message.put(line.end);
    message.put_list(line.points);
    if (message.bytes().size() < sender.message_bytes()) return;
    sender.send(message.bytes());
    message = message_of(Content::kOpenLines);
  });
  if (message.bytes().size() > none) sender.send(message.bytes());
}

void give_hull(HullEdges& hull, ShareSender& sender) {
  Packer message = message_of(Content::kHullEdges);
  const std::size_t none = message.bytes().size();
  hull.finish([&](const HullEdge& edge) {
    message.put(edge);
    if (message.bytes().size() < sender.message_bytes()) return;
    sender.send(message.bytes());
    message = message_of(Content::kHullEdges);
  });
  if (message.bytes().size() > none) sender.send(message.bytes());
}

void take_hull(std::span<const std::byte> bytes, HullEdges& hull) {
  for (Unpacker edges(bytes); !edges.empty();) hull.add(edges.take<HullEdge>());
}

void take_open_lines(std::span<const std::byte> bytes, LineJoiner& joiner) {
  for (Unpacker lines(bytes); !lines.empty();) {
    LineJoiner::OpenLine line;
    line.begin = lines.take<Crossing>();
    line.end = lines.take<Crossing>();
    line.points = lines.take_list<std::vector<Point<2>>>();
    joiner.add(std::move(line));
  }
}

}  // namespace

void give_contours(ContourWriter& writer, LineStore& lines, ShareSender& sender) {
  Packer statistics = message_of(Content::kStatistics);
  statistics.put(ContourStatistics{.lowest = writer.lowest(),
                                   .highest = writer.highest(),
                                   .lines = writer.lines(),
                                   .short_lines = writer.short_lines(),
                                   .spilled_bytes = writer.spilled_bytes() + lines.stored_bytes()});
  sender.send(statistics.bytes());
  for (auto some = lines.take(); !some.empty(); some = lines.take()) {
    std::vector<std::byte> message(1 + some.size());
    message.front() = static_cast<std::byte>(Content::kWholeLines);
    std::ranges::copy(some, message.begin() + 1);
    sender.send(message);
  }
  give_open_lines(writer.joiner(), sender);
  give_hull(writer.hull(), sender);
}

void take_contours(ContourWriter& writer, OtherShares& others, const ContourWriter::Sink& take_line,
                   const std::function<void(const ContourStatistics&)>& take_statistics) {
  for (std::size_t other = 0; other < others.count(); ++other) {
    while (const std::optional<std::vector<std::byte>> message = others.next(other)) {
      const auto bytes = std::span(*message).subspan(1);
      switch (static_cast<Content>(message->front())) {
        case Content::kStatistics:
          take_statistics(Unpacker(bytes).take<ContourStatistics>());
          break;
        case Content::kWholeLines:
          LineStore::for_each(bytes, take_line);
          break;
        case Content::kOpenLines:
          take_open_lines(bytes, writer.joiner());
          break;
        case Content::kHullEdges:
          take_hull(bytes, writer.hull());
          break;
      }
    }
  }
}

}  // namespace spillway::stream
