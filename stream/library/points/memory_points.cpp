#include <spillway/points.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace spillway {
namespace {

constexpr std::size_t kBlockPoints = 65536;

template <int D>
class MemoryPoints final : public PointSource {
 public:
  explicit MemoryPoints(PointView<D> points) : points_(points) {}
  explicit MemoryPoints(std::vector<Point<D>> points) : kept_(std::move(points)), points_(kept_) {}

  [[nodiscard]] PointsHeader header() const override {
    return {.coordinates = D, .count = points_.size()};
  }

  bool read(std::vector<Point<3>>& points) override {
    const std::size_t count = std::min(kBlockPoints, points_.size() - next_);
    points.assign(count, {});
    for (Point<3>& point : points) {
      const Point<D> from = points_[next_++];
      std::copy(from.begin(), from.end(), point.begin());
    }
    return count > 0;
  }

 private:
  std::vector<Point<D>> kept_;  ///< or none
  PointView<D> points_;
  std::size_t next_ = 0;
};

}  // namespace

PointSource::~PointSource() = default;
PointSink::~PointSink() = default;
void PointSink::begin(const PointsHeader& /*header*/) {}
void PointSink::finish() {}

std::unique_ptr<PointSource> points_in_memory(PointView<3> points) {
  return std::make_unique<MemoryPoints<3>>(points);
}

std::unique_ptr<PointSource> points_in_memory(PointView<2> points) {
  return std::make_unique<MemoryPoints<2>>(points);
}

std::unique_ptr<PointSource> points_in_memory(std::vector<Point<3>>&& points) {
  return std::make_unique<MemoryPoints<3>>(std::move(points));
}

std::unique_ptr<PointSource> points_in_memory(std::vector<Point<2>>&& points) {
  return std::make_unique<MemoryPoints<2>>(std::move(points));
}

}  // namespace spillway
