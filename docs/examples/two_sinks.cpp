// A tee: each block of a triangulation goes to two sinks, here to a counter and to a file.
#include <spillway/generate.h>
#include <spillway/info.h>
#include <spillway/triangulate.h>

#include <cstdio>

struct Tee : spillway::MeshSink {
  Tee(spillway::MeshSink& a, spillway::MeshSink& b) : first(a), second(b) {}
  void begin(const spillway::MeshHeader& header) override {
    first.begin(header);
    second.begin(header);
  }
  void write(const spillway::MeshBlock& block) override {
    first.write(block);
    second.write(block);
  }
  void finish(const spillway::MeshTotals& totals) override {
    first.finish(totals);
    second.finish(totals);
  }
  spillway::MeshSink& first;
  spillway::MeshSink& second;
};

int main() {
  const spillway::Context context({.memory = "64M"});
  std::size_t corners = 0;
  const auto counter =
      spillway::mesh_to([&](const auto& block) { corners += block.corners.size(); });
  const auto file = spillway::create_mesh("terrain.ply", {}, context);
  Tee tee(*counter, *file);
  const auto points = spillway::generate_points({.family = "terrain", .count = 10'000});
  spillway::triangulate(*points, tee, {}, context);

  std::printf("counted %zu triangles\n", corners / 3);
  const auto written = spillway::describe_mesh("terrain.ply", {}, context);
  std::printf("terrain.ply has %zu\n", std::size_t(written.totals.simplices));
}
