// A sink of meshes of one's own: looks for the longest edge, and holds only vertices in use.
#include <spillway/live_vertices.h>
#include <spillway/triangulate.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

class LongestEdge : public spillway::MeshSink {
 public:
  void write(const spillway::MeshBlock& block) override {
    in_use_.begin(block, block.vertices);
    for (std::size_t c = 0; c < block.corners.size(); c += 3) {
      for (int i = 0; i < 3; ++i) {
        const auto& a = in_use_.at(block.corners[c + i]);
        const auto& b = in_use_.at(block.corners[c + (i + 1) % 3]);
        length_ = std::max(length_, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
      }
    }
    in_use_.end(block);
  }

  double length_ = 0;
  spillway::LiveVertices<spillway::Point<3>> in_use_;
};

int main() {
  std::vector<spillway::Point<3>> slope;
  for (int x = 0; x <= 100; ++x) {
    for (int y = 0; y <= 100; ++y) slope.push_back({3.0 * x, 2.0 * y, 6.0 * x});
  }
  LongestEdge longest;
  spillway::triangulate(*spillway::points_in_memory(slope), longest, {}, spillway::Context());
  std::printf("the longest edge has %g\n", longest.length_);
  std::printf("%zu vertices are still in use\n", longest.in_use_.size());
}
