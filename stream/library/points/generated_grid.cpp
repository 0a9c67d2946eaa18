// Generated points as the files of a survey. Points are cheap to make and the same each time, so
// they are made again and again: for their extent, for what the tiles hold, and for each group of
// files that are open at a time. So any number of points and files takes the same memory.

#include <fmt/format.h>
#include <spillway/generate.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/disk/private_file.h"
#include "formats/disk/private_output.h"
#include "src/error.h"
#include "src/generators/survey_grid.h"
#include "stream/library/context/run_watch.h"
#include "stream/library/points/generated_points.h"
#include "stream/library/points/grid_names.h"
#include "stream/library/points/point_file.h"

namespace spillway::stream {
namespace {

constexpr std::size_t kMostFiles = 10'000;
/// More than this, and the strips on both sides of a narrow tile would meet.
constexpr double kMostOverlap = 0.4;
/// Each has a buffer of a megabyte.
constexpr std::size_t kMostOpenFiles = 128;
/// That a file takes.
constexpr std::size_t kPointsAtOnce = 4096;
/// Descriptors that are left for everything else.
constexpr std::size_t kSpareDescriptors = 32;

std::size_t files_at_a_time() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
    return kMostOpenFiles;
  }
  const std::size_t all = limit.rlim_cur;
  return std::clamp<std::size_t>(all > kSpareDescriptors ? all - kSpareDescriptors : 1, 1,
                                 kMostOpenFiles);
}

SurveyGridShape checked_shape(const GridOptions& grid, int dimension, std::uint64_t points) {
  if (dimension > 3) {
    throw InvalidArgument(
        fmt::format("the files of a grid have points of 2 or 3 dimensions, not {}", dimension));
  }
  if (points == 0) {
    throw InvalidArgument("a grid of 0 points would have no files: ask for 1 point at least");
  }
  if (grid.columns < 1 || grid.rows < 1) {
    throw InvalidArgument(fmt::format("a grid has 1 column and 1 row at least, not {} x {}",
                                      grid.columns, grid.rows));
  }
  const SurveyGridShape shape{.columns = static_cast<std::size_t>(grid.columns),
                              .rows = static_cast<std::size_t>(grid.rows),
                              .overlap = grid.overlap};
  if (shape.columns * shape.rows > kMostFiles) {
    throw InvalidArgument(fmt::format("a grid of {} x {} is more than {} files", grid.columns,
                                      grid.rows, kMostFiles));
  }
  if (!(grid.overlap >= 0 && grid.overlap <= kMostOverlap)) {
    throw InvalidArgument(fmt::format("files of a grid overlap by 0 to {} of a tile, not {}",
                                      kMostOverlap, grid.overlap));
  }
  return shape;
}

/// Files that lie in a private folder until all are complete.
class GridFiles final : public FileSystem {
 public:
  explicit GridFiles(const std::string& pattern) : output_(pattern) {}

  std::unique_ptr<InputFile> open(const std::string& path) override { return disk().open(path); }
  [[nodiscard]] bool exists(const std::string& path) const override { return disk().exists(path); }

  std::unique_ptr<OutputFile> create(const std::string& path) override {
    const std::filesystem::path here(output_.path());
    return create_private_file(here.parent_path() / std::filesystem::path(path).filename(), path);
  }

  void finish() { output_.finish({}); }

 private:
  PrivateOutput output_;
};

/// Tiles whose files are open at a time, up to `end`.
struct TileRange {
  std::size_t first;
  std::size_t end;
};

/// What a tile holds.
struct Tile {
  std::uint64_t points = 0;
  Box<3> box{};  ///< as points come: on the lattice, if there is one
};

/// A tile whose file is being written; or one without points, which has none.
struct OpenTile {
  std::unique_ptr<PointFile> file;
  PointBlock block;

  void take(const LatticePoint& point, std::uint64_t index) {
    block.points.push_back(point);
    block.index.push_back(index);
    if (block.size() == kPointsAtOnce) append();
  }

  void append() {
    file->append(block);
    block.clear();
  }

  void complete() {
    if (!file) return;
    append();
    file->complete();
  }
};

class GridWriter {
 public:
  GridWriter(const GenerateOptions& points, const std::string& path, const GridOptions& grid,
             const Context& context)
      : points_(points),
        shape_(checked_shape(grid, points.dimension, points.count)),
        names_(path, shape_.columns, shape_.rows),
        path_(path),
        options_{.format = grid.format, .las_version = grid.las_version, .exact = true},
        context_(context),
        watch_(context) {}

  GridReport run() {
    watch_.check();
    names_.refuse_existing();
    try_to_write();
    GridFiles files(path_);
    watch_.begin("measure", "points");
    const SurveyGrid grid(extent(), shape_, points_.seed);
    const std::vector<Tile> tiles = measure(grid);
    watch_.end(points_.count);
    watch_.begin("generate", "points");
    write(grid, tiles, files);
    files.finish();
    watch_.end(points_.count);
    const auto holds = [](const Tile& tile) { return tile.points > 0; };
    return {.points = points_.count,
            .files = static_cast<std::uint64_t>(std::ranges::count_if(tiles, holds))};
  }

 private:
  using UseBlock = std::function<void(const PointBlock&)>;

  /// One time out of several that all points are made in a phase.
  struct Round {
    std::size_t number;
    std::size_t all;
  };

  void for_each_block(PointStream& points, const Round& round, const UseBlock& use) {
    SourcePiece piece;
    PointBlock block;
    while (points.fetch(piece)) {
      points.decode(piece, block);
      use(block);
      const double rounds = static_cast<double>(round.number) + points.fraction_read().value_or(1);
      const double fraction = rounds / static_cast<double>(round.all);
      watch_.tell(static_cast<std::uint64_t>(fraction * static_cast<double>(points_.count)),
                  fraction);
    }
  }

  /// What cannot be written is told before any point is made.
  void try_to_write() {
    GeneratedPoints points(points_);
    GridFiles files(path_);
    PointFile file(path_, options_, context_, files);
    file.start(points.begin(watch_, false));
  }

  Box<3> extent() {
    GeneratedPoints points(points_);
    Box<3> box;
    for_each_block(*points.begin(watch_, false).stream, {0, 2}, [&](const PointBlock& block) {
      for (const LatticePoint& point : block.points) box.expand(point);
    });
    return box;
  }

  std::vector<Tile> measure(const SurveyGrid& grid) {
    GeneratedPoints points(points_);
    std::vector<Tile> tiles(grid.size());
    for_each_block(*points.begin(watch_, false).stream, {1, 2}, [&](const PointBlock& block) {
      for (std::size_t i = 0; i < block.size(); ++i) {
        Tile& tile = tiles[grid.tile_of(block.points[i], block.index[i])];
        ++tile.points;
        tile.box.expand(block.points[i]);
      }
    });
    return tiles;
  }

  void write(const SurveyGrid& grid, const std::vector<Tile>& tiles, GridFiles& files) {
    const std::size_t at_a_time = files_at_a_time();
    const std::size_t groups = (tiles.size() + at_a_time - 1) / at_a_time;
    for (std::size_t group = 0; group < groups; ++group) {
      const std::size_t first = group * at_a_time;
      write_group(grid, tiles, {first, std::min(tiles.size(), first + at_a_time)}, files,
                  {group, groups});
    }
  }

  void write_group(const SurveyGrid& grid, const std::vector<Tile>& tiles, const TileRange& group,
                   GridFiles& files, const Round& round) {
    GeneratedPoints points(points_);
    const RunPoints run = points.begin(watch_, false);
    std::vector<OpenTile> open(group.end - group.first);
    for (std::size_t tile = group.first; tile < group.end; ++tile) {
      if (tiles[tile].points == 0) continue;
      OpenTile& its = open[tile - group.first];
      its.file = std::make_unique<PointFile>(names_.path(tile), options_, context_, files);
      its.file->start(points_of(run, tiles[tile]));
    }
    for_each_block(*run.stream, round, [&](const PointBlock& block) {
      for (std::size_t i = 0; i < block.size(); ++i) {
        const std::size_t tile = grid.tile_of(block.points[i], block.index[i]);
        if (tile < group.first || tile >= group.end) continue;
        open[tile - group.first].take(block.points[i], block.index[i]);
      }
    });
    for (OpenTile& tile : open) tile.complete();
  }

  /// What the header of a tile's file tells.
  static RunPoints points_of(const RunPoints& run, const Tile& tile) {
    RunPoints of_tile = run;
    const std::optional<IntegerLattice>& lattice = run.stream->lattice();
    of_tile.records = tile.points;
    of_tile.extent.emplace();
    of_tile.extent->expand(in_world(lattice, LatticePoint(tile.box.lo)));
    of_tile.extent->expand(in_world(lattice, LatticePoint(tile.box.hi)));
    return of_tile;
  }

  GenerateOptions points_;
  SurveyGridShape shape_;
  GridNames names_;
  std::string path_;
  PointFileOptions options_;
  const Context& context_;
  RunWatch watch_;
};

}  // namespace
}  // namespace spillway::stream

namespace spillway {

GridReport generate_grid(const GenerateOptions& points, const std::string& path,
                         const GridOptions& grid, const Context& context) {
  return stream::GridWriter(points, path, grid, context).run();
}

}  // namespace spillway
