// A product of one's own: the mean slope of a terrain, weighed by area, by all threads of the run.
#include <spillway/product.h>
#include <spillway/triangulate.h>

#include <cmath>
#include <cstdio>
#include <vector>

struct MeanSlope {
  double weighed = 0;  // slopes times areas
  double area = 0;

  void add(const spillway::SimplexBlock& block) {
    for (std::size_t c = 0; c < block.corners.size(); c += 3) {
      const auto& a = block.vertices[block.corners[c]];
      const auto& b = block.vertices[block.corners[c + 1]];
      const auto& d = block.vertices[block.corners[c + 2]];
      const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
      const double v[3] = {d[0] - a[0], d[1] - a[1], d[2] - a[2]};
      const double normal[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                u[0] * v[1] - u[1] * v[0]};  // as long as twice the area
      weighed += std::hypot(normal[0], normal[1]) / 2;
      area += normal[2] / 2;
    }
  }
  void combine(const MeanSlope& other) {
    weighed += other.weighed;
    area += other.area;
  }
};

int main() {
  std::vector<spillway::Point<3>> ridge;
  for (int x = 0; x <= 200; ++x) {
    for (int y = 0; y <= 100; ++y) ridge.push_back({1.0 * x, 1.0 * y, x <= 100 ? 0.5 * x : 50.0});
  }
  const spillway::Context context;
  spillway::Product<MeanSlope> product(context);
  spillway::triangulate(*spillway::points_in_memory(ridge), product.sink(), {}, context);
  const MeanSlope& slope = product.result();
  std::printf("area %g, mean slope %g\n", slope.area, slope.weighed / slope.area);
}
