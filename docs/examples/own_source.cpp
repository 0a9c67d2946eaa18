// A source of points of one's own: computes a dome row by row, so that no array has all points.
#include <spillway/triangulate.h>

#include <cstdio>

class Dome : public spillway::PointSource {
 public:
  spillway::PointsHeader header() const override { return {.count = kSide * kSide}; }

  bool read(std::vector<spillway::Point<3>>& points) override {
    points.clear();
    if (row_ == kSide) return false;
    for (int column = 0; column < kSide; ++column) {
      const double x = column - kMiddle;
      const double y = row_ - kMiddle;
      points.push_back({x, y, 1000 - 0.01 * (x * x + y * y)});
    }
    ++row_;
    return true;
  }

 private:
  static constexpr int kSide = 401;
  static constexpr int kMiddle = kSide / 2;
  int row_ = 0;
};

int main() {
  const spillway::Context context({.memory = "32M", .threads = 2});
  Dome dome;
  spillway::MeshInMemory mesh;
  const auto report = spillway::triangulate(dome, mesh, {}, context);
  std::printf("%zu points\n", std::size_t(report.points.read));
  std::printf("%zu triangles\n", mesh.corners().size() / 3);
}
