#pragma once
// Runs the pipeline on points given in memory and keeps what it writes.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"
#include "formats/meshes/common/stream_numbers.h"
#include "formats/meshes/common/stream_vertices.h"
#include "formats/points/attributes/further_coordinates.h"
#include "formats/points/common/point_writer.h"
#include "formats/points/create_points.h"
#include "stream/pipeline.h"
#include "stream/source/joined_inputs.h"
#include "tests/stream/quiet_setup.h"

namespace spillway::test {

/// What the points of a test carry: their number in the input, and its lowest byte, so that records
/// have an odd size.
inline AttributeLayout number_attributes() {
  return AttributeLayout({{"number", NumberType::kUint32}, {"low_byte", NumberType::kUint8}});
}

inline void append_number_record(std::uint64_t number, std::vector<std::byte>& records) {
  const auto value = static_cast<std::uint32_t>(number);
  const auto bytes = std::as_bytes(std::span(&value, 1));
  records.insert(records.end(), bytes.begin(), bytes.end());
  records.push_back(static_cast<std::byte>(number));
}

/// Whether each vertex of these carries the attributes of the point whose index it has.
inline void expect_attributes_of(const std::vector<std::uint64_t>& index,
                                 const std::vector<std::byte>& attributes) {
  std::vector<std::byte> expected;
  for (const std::uint64_t number : index) append_number_record(number, expected);
  EXPECT_TRUE(attributes == expected) << "attributes are not those of the vertices' points";
}

/// Runs on an even number of threads carry attributes, so that both kinds are tried.
inline bool carries_attributes(const EngineOptions& options) { return options.threads % 2 == 0; }

/// Keeps all blocks, and checks on the way that vertices are announced before and finalized after
/// their last use, once each, and that a block imports what it uses or finalizes, and nothing else;
/// and that attributes, if there are any besides coordinates, are those of the point with the
/// vertex' index.
class KeepingWriter : public BlockSink {
 public:
  explicit KeepingWriter(int dimension)
      : corners_(dimension + 1), coordinates_(further_axes(dimension) * sizeof(double)) {}

  void write(MeshStreamBlock&& block) override {
    ASSERT_EQ(block.corners.size() % corners_, 0U);
    const StreamNumbers numbers(live_.announced(), block);
    for (const std::uint64_t v : block.imported) {
      EXPECT_TRUE(live_.contains(v)) << "vertex " << v << " is imported, but not alive";
    }
    for (std::size_t v = 0; v < block.vertices.size(); ++v) live_.enter(numbers[v], {});
    live_.announce(block.vertices.size());
    std::set<std::uint32_t> used(block.finalized.begin(), block.finalized.end());
    for (const std::uint32_t c : block.corners) {
      ASSERT_LT(c, numbers.size());
      used.insert(c);
      corner_list.push_back(numbers[c]);
    }
    for (std::size_t v = block.vertices.size(); v < numbers.size(); ++v) {
      ASSERT_TRUE(used.contains(static_cast<std::uint32_t>(v)))
          << "vertex " << numbers[v] << " is imported for nothing";
    }
    for (const std::uint32_t v : block.finalized) {
      ASSERT_LT(v, numbers.size());
      EXPECT_TRUE(live_.forget(numbers[v])) << "vertex finalized twice";
    }
    vertices.insert(vertices.end(), block.vertices.begin(), block.vertices.end());
    index.insert(index.end(), block.input_index.begin(), block.input_index.end());
    const std::vector<std::byte> attributes = without_coordinates(block);
    if (!attributes.empty()) expect_attributes_of(block.input_index, attributes);
    has_attributes |= !attributes.empty();
    most_live = std::max(most_live, live_.size());
    blocks.push_back(std::move(block));
  }
  void finish(const MeshTotals&) override {}
  [[nodiscard]] std::size_t live() const { return live_.size(); }

  std::vector<LatticePoint> vertices;
  std::vector<std::uint64_t> index;
  std::vector<std::uint64_t> corner_list;
  std::vector<MeshStreamBlock> blocks;
  std::size_t most_live = 0;
  bool has_attributes = false;

 private:
  [[nodiscard]] std::vector<std::byte> without_coordinates(const MeshStreamBlock& block) const {
    if (coordinates_ == 0 || block.vertices.empty()) return block.attributes;
    const std::size_t size = block.attributes.size() / block.vertices.size();
    std::vector<std::byte> others;
    for (auto record = block.attributes.begin(); record != block.attributes.end();
         record += static_cast<std::ptrdiff_t>(size)) {
      others.insert(others.end(), record + static_cast<std::ptrdiff_t>(coordinates_),
                    record + static_cast<std::ptrdiff_t>(size));
    }
    return others;
  }

  std::size_t corners_;
  std::size_t coordinates_;  ///< bytes of those beyond z in a record
  StreamVertices<std::monostate> live_;
};

/// A file of points in the test's temporary folder, of this process alone. They carry numbers from
/// `first_number` on.
template <int D>
std::string write_points(const std::vector<Point<D>>& points, std::uint64_t first_number = 0) {
  const std::string path = ::testing::TempDir() + "points" + std::to_string(::getpid()) + ".npy";
  PointWriterOptions options;
  options.coordinates = std::min(D, kOwnAxes);
  options.count = points.size();
  std::vector<Attribute> attributes = further_coordinates(D).attributes();
  for (const Attribute& number : number_attributes().attributes()) attributes.push_back(number);
  options.attributes = AttributeLayout(std::move(attributes));
  const auto writer = open_point_writer(disk(), path, options);
  std::vector<LatticePoint> block;
  std::vector<std::byte> records;
  for (const Point<D>& p : points) {
    append_further_coordinates<D>(p, records);
    append_number_record(first_number + block.size(), records);
    block.emplace_back(own_coordinates<D>(p));
  }
  writer->write(block, records);
  writer->finish();
  return path;
}

struct StreamRun {
  RunStatistics statistics;
  KeepingWriter mesh;
};

template <int D>
StreamRun run_stream(const std::string& path, EngineOptions options,
                     std::uint64_t memory = std::uint64_t{1} << 30) {
  StreamRun run{{}, KeepingWriter(D)};
  options.asked.input_index = true;
  JoinedInputs source(disk(), {path}, {.dimension = D, .index = true});
  if (carries_attributes(options)) source.carry({.all = true});
  options.record_size = source.attributes().record_size();
  QuietSetup setup(options, memory);
  run.statistics = triangulate_stream<D>(source, run.mesh, setup);
  EXPECT_EQ(run.mesh.has_attributes, carries_attributes(options));
  return run;
}

/// All simplices as sorted input indices, sorted.
template <int D>
std::vector<std::array<VertexId, D + 1>> simplices_of(const KeepingWriter& mesh) {
  std::vector<std::array<VertexId, D + 1>> simplices(mesh.corner_list.size() / (D + 1));
  for (std::size_t i = 0; i < mesh.corner_list.size(); ++i) {
    simplices[i / (D + 1)][i % (D + 1)] = static_cast<VertexId>(mesh.index[mesh.corner_list[i]]);
  }
  for (auto& s : simplices) std::sort(s.begin(), s.end());
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

}  // namespace spillway::test
