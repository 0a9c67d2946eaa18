#pragma once
// Runs the pipeline over ranks on points that rank 0 has, and brings together what all ranks made.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "src/runtime/packing.h"
#include "stream/ranks/rank_pipeline.h"
#include "tests/distributed/world.h"
#include "tests/stream/stream_runner.h"

namespace spillway::test {

/// The points in so many files in the test's temporary folder; made by rank 0, known to all.
template <int D>
std::vector<std::string> write_shared_points(const std::vector<Point<D>>& points,
                                             std::size_t files) {
  std::vector<std::string> paths;
  for (std::size_t f = 0; f < files; ++f) {
    const std::size_t begin = points.size() * f / files;
    const std::size_t end = points.size() * (f + 1) / files;
    const std::string path = write_points<D>({points.begin() + static_cast<std::ptrdiff_t>(begin),
                                              points.begin() + static_cast<std::ptrdiff_t>(end)},
                                             begin);
    paths.push_back(fmt::format("{}.{}.npy", path, f));
    std::filesystem::rename(path, paths.back());
  }
  return paths;
}

/// What one rank made of its share.
struct RankRunResult {
  RankMesh mesh;
  KeepingWriter own;
  bool carries = false;  ///< attributes
};

template <int D>
RankRunResult run_over_ranks(const std::vector<std::string>& paths, EngineOptions options,
                             std::uint64_t memory = std::uint64_t{1} << 30) {
  const distributed::Ranks& ranks = world();
  RankRunResult run{{}, KeepingWriter(D), carries_attributes(options)};
  options.asked.input_index = true;
  const auto source = open_shared_source(disk(), paths, {.dimension = D, .index = true}, ranks);
  if (run.carries) {
    source->carry({.all = true});
    options.record_size = source->attributes().record_size();
  }
  QuietSetup setup(options, memory);
  run.mesh = triangulate_over_ranks<D>(*source, run.own, setup, ranks);
  return run;
}

/// What all ranks made together; at rank 0.
template <int D>
struct WholeMesh {
  std::vector<std::array<VertexId, D + 1>> simplices;  ///< as sorted input indices, sorted
  std::vector<std::uint64_t> input_index;              ///< by number in the whole stream
};

namespace rank_runner_internal {

/// Appends the simplices of a block as input indices.
template <int D>
void append_simplices(const MergedSection& section,
                      std::vector<std::array<VertexId, D + 1>>& simplices) {
  std::vector<std::uint64_t> index = section.mesh.input_index;
  index.insert(index.end(), section.imported_index.begin(), section.imported_index.end());
  for (std::size_t i = 0; i < section.mesh.corners.size(); i += D + 1) {
    auto& simplex = simplices.emplace_back();
    for (int k = 0; k <= D; ++k) {
      simplex[k] = static_cast<VertexId>(index.at(section.mesh.corners[i + k]));
    }
    std::sort(simplex.begin(), simplex.end());
  }
}

}  // namespace rank_runner_internal

/// Collective.
template <int D>
WholeMesh<D> gather_mesh(const RankRunResult& run) {
  const distributed::Ranks& ranks = world();
  auto simplices = simplices_of<D>(run.own);
  std::vector<std::array<std::uint64_t, 2>> named;     // number in the whole stream, input index
  std::vector<std::array<std::uint64_t, 2>> imported;  // likewise, where it is used again
  if (run.mesh.own_section) {
    const std::uint64_t first = run.mesh.sections[*run.mesh.own_section].first_vertex;
    for (std::size_t v = 0; v < run.own.index.size(); ++v) {
      named.push_back({first + v, run.own.index[v]});
    }
  }
  for (const MergedSection& section : run.mesh.merged) {
    rank_runner_internal::append_simplices<D>(section, simplices);
    if (run.carries) {
      expect_attributes_of(section.mesh.input_index, section.mesh.attributes);
      expect_attributes_of(section.imported_index, section.imported_attributes);
    }
    const std::uint64_t first = run.mesh.sections[section.section].first_vertex;
    for (std::size_t v = 0; v < section.mesh.input_index.size(); ++v) {
      named.push_back({first + v, section.mesh.input_index[v]});
    }
    for (std::size_t v = 0; v < section.imported_index.size(); ++v) {
      imported.push_back({section.mesh.imported.at(v), section.imported_index[v]});
    }
  }
  Packer packer;
  packer.put_list(simplices);
  packer.put_list(named);
  packer.put_list(imported);
  WholeMesh<D> mesh;
  std::vector<std::array<std::uint64_t, 2>> uses;
  mesh.input_index.assign(run.mesh.totals.vertices, ~std::uint64_t{0});
  for (const auto& bytes : ranks.gather(packer.bytes(), 0)) {
    Unpacker unpacker(bytes);
    const auto some = unpacker.take_list<std::vector<std::array<VertexId, D + 1>>>();
    mesh.simplices.insert(mesh.simplices.end(), some.begin(), some.end());
    for (const auto& [number, index] :
         unpacker.take_list<std::vector<std::array<std::uint64_t, 2>>>()) {
      EXPECT_EQ(mesh.input_index.at(number), ~std::uint64_t{0}) << "two vertices of one number";
      mesh.input_index.at(number) = index;
    }
    for (const auto& use : unpacker.take_list<std::vector<std::array<std::uint64_t, 2>>>()) {
      uses.push_back(use);
    }
  }
  for (const auto& [number, index] : uses) EXPECT_EQ(mesh.input_index.at(number), index);
  std::sort(mesh.simplices.begin(), mesh.simplices.end());
  return mesh;
}

}  // namespace spillway::test
