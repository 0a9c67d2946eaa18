#include "tools/mesh_output.h"

#include <array>
#include <memory>

#include "src/geometry/canonical_hash.h"
#include "src/parallel/parallel.h"

namespace spillway {
namespace {

constexpr std::size_t kBlockSize = 65536;  // vertices or simplices handed to the writer at a time

template <int D>
double squared_distance(const Point<3>& a, const Point<3>& b) {
  double sum = 0;
  for (int k = 0; k < D; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/// Which simplices are written, and what they look like.
template <int D>
class Selector {
 public:
  Selector(const TriangulatedPoints<D>& points, const MeshSelection& selection)
      : points_(points), max_edge_(selection.max_edge) {}

  /// Whether a finite simplex has no edge that is too long.
  [[nodiscard]] bool keeps(const Simplex<D>& simplex) const {
    if (!max_edge_) return true;
    std::array<Point<3>, D + 1> corners;
    for (int i = 0; i <= D; ++i) corners[i] = points_.world(simplex.vertices[i]);
    const double longest = *max_edge_ * *max_edge_;
    for (int i = 0; i <= D; ++i) {
      for (int j = 0; j < i; ++j) {
        if (squared_distance<D>(corners[i], corners[j]) > longest) return false;
      }
    }
    return true;
  }

  /// Adds one block's simplices to the figures; boundary facets only where simplices are left out,
  /// as the triangulation knows its own hull.
  void measure(std::uint32_t block, MeshFigures& figures, CanonicalHash<D>& hash) const {
    const auto& simplices = points_.triangulation.blocks[block].simplices;
    for (std::uint32_t i = 0; i < simplices.size(); ++i) {
      const Simplex<D>& simplex = simplices[i];
      if (simplex.removed() || simplex.infinite()) continue;
      if (!keeps(simplex)) {
        ++figures.left_out;
        continue;
      }
      ++figures.simplices;
      if (max_edge_) figures.hull_facets += boundary_facets({block, i});
      hash.add(flat_corners(simplex));
    }
  }

 private:
  [[nodiscard]] std::uint64_t boundary_facets(SimplexId id) const {
    std::uint64_t count = 0;
    for (int i = 0; i <= D; ++i) {
      const Simplex<D>& neighbour =
          points_.triangulation.simplex(points_.triangulation.neighbour(id, i));
      if (neighbour.infinite() || !keeps(neighbour)) ++count;
    }
    return count;
  }

  [[nodiscard]] std::array<Point<D>, D + 1> flat_corners(const Simplex<D>& simplex) const {
    std::array<Point<D>, D + 1> corners;
    for (int i = 0; i <= D; ++i) {
      const Point<3> world = points_.world(simplex.vertices[i]);
      for (int k = 0; k < D; ++k) corners[i][k] = world[k];
    }
    return corners;
  }

  const TriangulatedPoints<D>& points_;
  std::optional<double> max_edge_;
};

/// Writes the vertices and returns the number each got in the file, by vertex of the triangulation.
template <int D>
std::vector<VertexId> write_vertices(const TriangulatedPoints<D>& points, MeshWriter& writer) {
  const Triangulation<D>& triangulation = points.triangulation;
  std::vector<VertexId> number_in_file(triangulation.points.size(), kNoVertex);
  std::vector<Point<3>> block;
  std::vector<std::uint64_t> index;
  VertexId written = 0;
  auto duplicate = triangulation.duplicates.begin();
  const auto flush = [&] {
    writer.write_vertices(block, index);
    block.clear();
    index.clear();
  };
  for (VertexId v = 0; v < triangulation.points.size(); ++v) {
    if (duplicate != triangulation.duplicates.end() && duplicate->dropped == v) {
      ++duplicate;
      continue;
    }
    number_in_file[v] = written++;
    block.push_back(points.world(v));
    if (!points.index.empty()) index.push_back(points.index[triangulation.input_index[v]]);
    if (block.size() == kBlockSize) flush();
  }
  if (!block.empty()) flush();
  return number_in_file;
}

}  // namespace

template <int D>
MeshFigures measure_mesh(const TriangulatedPoints<D>& points, const MeshSelection& selection,
                         unsigned threads) {
  const std::size_t blocks = points.triangulation.blocks.size();
  const Selector<D> selector(points, selection);
  std::vector<MeshFigures> figures(blocks);
  std::vector<CanonicalHash<D>> hashes(blocks);
  with_threads(threads == 0 ? available_threads() : threads, [&] {
    parallel_for(blocks, 1, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        selector.measure(static_cast<std::uint32_t>(b), figures[b], hashes[b]);
      }
    });
  });
  MeshFigures sum;
  CanonicalHash<D> hash;
  sum.vertices = points.triangulation.vertex_count();
  if (!selection.max_edge) sum.hull_facets = points.triangulation.hull.size();
  for (std::size_t b = 0; b < blocks; ++b) {
    sum.simplices += figures[b].simplices;
    sum.left_out += figures[b].left_out;
    sum.hull_facets += figures[b].hull_facets;
    hash.add(hashes[b]);
  }
  sum.canonical_hash = hash.value();
  return sum;
}

template <int D>
void write_mesh(const TriangulatedPoints<D>& points, const MeshSelection& selection,
                const MeshFigures& figures, FileSystem& files, const std::string& path,
                MeshFormat format, Progress& progress) {
  MeshHeader header;
  header.dimension = D;
  header.vertices = figures.vertices;
  header.simplices = figures.simplices;
  header.has_input_index = !points.index.empty();
  header.lattice = points.lattice;
  header.crs = points.crs;
  const auto writer = open_mesh_writer(files, path, format, header);

  const std::vector<VertexId> number_in_file = write_vertices(points, *writer);
  const Selector<D> selector(points, selection);
  std::vector<std::uint64_t> corners;
  std::uint64_t written = 0;
  const auto flush = [&] {
    writer->write_simplices(corners);
    written += corners.size() / (D + 1);
    corners.clear();
    progress.update(written, static_cast<double>(written) / static_cast<double>(figures.simplices));
  };
  points.triangulation.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    if (simplex.infinite() || !selector.keeps(simplex)) return;
    for (const VertexId v : simplex.vertices) corners.push_back(number_in_file[v]);
    if (corners.size() == kBlockSize * (D + 1)) flush();
  });
  if (!corners.empty()) flush();
  writer->finish();
}

template MeshFigures measure_mesh<2>(const TriangulatedPoints<2>&, const MeshSelection&, unsigned);
template MeshFigures measure_mesh<3>(const TriangulatedPoints<3>&, const MeshSelection&, unsigned);
template void write_mesh<2>(const TriangulatedPoints<2>&, const MeshSelection&, const MeshFigures&,
                            FileSystem&, const std::string&, MeshFormat, Progress&);
template void write_mesh<3>(const TriangulatedPoints<3>&, const MeshSelection&, const MeshFigures&,
                            FileSystem&, const std::string&, MeshFormat, Progress&);

}  // namespace spillway
