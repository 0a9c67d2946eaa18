#include "stream/tiles/storage/parted_points.h"

#include <cstring>

#include "stream/points/point_buffer.h"

namespace spillway::stream {

std::vector<HeldPoints> part_points(HeldPoints held, const Cut& first,
                                    const std::array<Cut, 2>& second) {
  constexpr std::size_t kParts = 4;
  std::vector<HeldPoints> parts(kParts);
  for (HeldPoints& part : parts) {
    part.arrival = held.arrival;
    part.run = held.run;
  }
  constexpr std::size_t kMost = PointBuffer::kPagePoints;
  PointBlock dealt;
  dealt.points.resize(kParts * kMost);
  held.buffer.drain([&](const PointsView& some) {
    const std::size_t record = some.record_size();
    if (!some.index.empty()) dealt.index.resize(dealt.size());
    dealt.attributes.resize(dealt.size() * record);
    std::array<std::size_t, kParts> counts{};
    for (std::size_t i = 0; i < some.size(); ++i) {
      const LatticePoint& point = some.points[i];
      const std::size_t side = point[first.axis] >= first.value ? 1 : 0;
      const Cut& next = second[side];
      const std::size_t part = 2 * side + (point[next.axis] >= next.value ? 1 : 0);
      const std::size_t place = part * kMost + counts[part]++;
      dealt.points[place] = point;
      if (!some.index.empty()) dealt.index[place] = some.index[i];
      if (record > 0) {
        std::memcpy(&dealt.attributes[place * record], &some.attributes[i * record], record);
      }
    }
    for (std::size_t p = 0; p < kParts; ++p) {
      const PointsView of_part = PointsView::of(dealt).subview(p * kMost, counts[p]);
      for (const LatticePoint& point : of_part.points) parts[p].box.expand(point);
      parts[p].buffer.append(of_part);
    }
  });
  return parts;
}

}  // namespace spillway::stream
