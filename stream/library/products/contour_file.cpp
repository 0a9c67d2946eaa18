#include "stream/library/products/contour_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "formats/disk/output_check.h"
#include "formats/gdal/gdal.h"
#include "formats/vectors/vector_formats.h"
#include "stream/library/context/context_state.h"
#include "stream/library/context/executor.h"
#include "stream/library/products/surface_units.h"
#include "stream/sinks/contour_shares.h"

namespace spillway::stream {
namespace {

/// The part of the memory that is for points of lines that are not complete.
constexpr std::uint64_t kLineShare = 4;
/// The part of these that is for pieces of lines that are.
constexpr std::uint64_t kPieceShare = 4;

const VectorFormat& format_of(const std::string& path) {
  if (const VectorFormat* const format = vector_format_of_path(path)) return *format;
  throw InvalidArgument(
      fmt::format("{}: contours go to a file that ends in {}", path, vector_extensions(true)));
}

Levels levels_of(const ContourOptions& options) {
  if (options.levels.empty()) return Levels::every(options.interval, options.base);
  if (options.interval != 0) {
    throw InvalidArgument("contours have an interval or a list of levels, not both");
  }
  return Levels::of_list(options.levels);
}

void check_positive(const char* name, const std::optional<double>& length) {
  if (!length || (*length > 0 && std::isfinite(*length))) return;
  throw InvalidArgument(fmt::format("{} is {}, but must be above 0", name, *length));
}

}  // namespace

ContourFile::ContourFile(const std::string& path, const ContourOptions& options,
                         const Context& context)
    : OwnSink(context),
      path_(path),
      format_(format_of(path)),
      options_(options),
      levels_(levels_of(options)),
      tiling_(make_vector_tiling(path, options.tile_side, options.tile_polygons)),
      scratch_(context.state().scratch(context)),
      writes_file_(is_first_process(context)) {
  check_max_edge(options_.max_edge);
  if (options_.index == 0) {
    throw InvalidArgument("index is 0, but every so many-th line is an index contour: 1 at least");
  }
  check_positive("min_length", options_.min_length);
  check_positive("smooth", options_.smooth);
  check_positive("simplify", options_.simplify);
  if (options_.bands && options_.min_length) {
    throw InvalidArgument("bands have all lines as their boundaries: no min_length");
  }
  if (options_.bands && !format_.holds_polygons) {
    throw InvalidArgument(fmt::format("{}: {} holds lines only; bands go to {}", path_,
                                      format_.title, "gpkg, shp or geojson"));
  }
  if (!writes_file_) return;
  check_can_create(path_);
  if (!tiling_) tell_lost_layers(format_, path_, context);
}

std::uint64_t ContourFile::own_memory(std::uint64_t limit) const { return limit / kLineShare; }

std::uint64_t ContourFile::memory_of_pieces() const {
  return tiling_ ? own_memory(context().memory()) / kPieceShare : 0;
}

BlockSink& ContourFile::open(const MeshStart& start) {
  refuse_tetrahedra(start);
  refuse_without_heights(start);
  if (tiling_ && !options_.foreign_crs) {
    check_same_crs(start.name, start.header.crs, options_.tile_polygons, tiling_->crs(),
                   options_.tile_polygons);
  }
  layer_.path = path_;
  layer_.content = options_.bands ? VectorContent::kBands : VectorContent::kLines;
  layer_.crs = start.header.crs;
  layer_.as_they_are = keeps_coordinates(start);
  contours_ = {.levels = levels_,
               .lattice = start.header.lattice,
               .max_edge = start.is_triangulated ? std::nullopt : options_.max_edge,
               .min_length = options_.min_length,
               .tolerance = {.smooth = options_.smooth.value_or(0),
                             .simplify = options_.simplify.value_or(0)},
               .finds_hull = options_.bands,
               .memory = own_memory(context().memory()) - memory_of_pieces()};
  return *begin_again();
}

BlockSink* ContourFile::begin_again() {
  report_ = {};
  writer_.reset();
  bands_.reset();
  if (writes_file_ && tiling_) {
    pieces_.emplace("contours", memory_of_pieces(), *scratch_);
  } else if (writes_file_) {
    file_.emplace(format_, layer_);
  } else {
    lines_.emplace(*scratch_);
  }
  if (writes_file_ && options_.bands) bands_.emplace(levels_, *scratch_);
  HullEdges::Sink hull_sink;
  if (bands_) hull_sink = [this](const HullEdge& edge) { bands_->add_hull_edge(edge); };
  return &writer_.emplace(
      contours_,
      [this](std::span<const Point<2>> points, std::int64_t level) { add(points, level); },
      *scratch_, hull_sink);
}

/// Whether coordinates are written as they are, though they are to be longitude and latitude.
/// Throws Failure if that is so, and not agreed to.
bool ContourFile::keeps_coordinates(const MeshStart& start) const {
  if (!format_.is_lonlat) return false;
  const std::string& crs = start.header.crs;
  std::string reason = fmt::format("{} names no coordinate system to find them by", start.name);
  if (!crs.empty()) {
    reason = gdal().why_not_lonlat(crs);
    if (reason.empty()) return false;
    reason = fmt::format("that of {}, {}, does not tell them: {}", start.name, gdal().crs_name(crs),
                         reason);
  }
  const std::string what =
      fmt::format("{} holds longitude and latitude in WGS 84, and {}", format_.title, reason);
  if (!options_.foreign_crs) {
    throw Failure(what, ErrorCode::kBadInput, {.file = start.name, .remedy = Remedy::kUnknownCrs});
  }
  if (context().options().warning) {
    context().options().warning(
        fmt::format("warning: {}; coordinates are written as they are", what));
  }
  return true;
}

void ContourFile::add(std::span<const Point<2>> points, std::int64_t level) {
  if (lines_) return lines_->add(points, level);
  if (bands_) return bands_->add_line(points, level);
  if (pieces_) return add_pieces(points, level);
  add_line(file_->layer(), points, level);
}

void ContourFile::add_pieces(std::span<const Point<2>> points, std::int64_t level) {
  bool is_in_a_tile = false;
  tiling_->cut(points, [&](std::size_t tile, std::span<const Point<2>> piece) {
    is_in_a_tile = true;
    Packer record;
    LineStore::put(record, piece, level);
    pieces_->add(tile, record.bytes());
  });
  if (!is_in_a_tile) ++report_.outside_tiles;
}

void ContourFile::add_line(VectorLayer& layer, std::span<const Point<2>> points,
                           std::int64_t level) {
  const double height = levels_.height(level);
  line_.clear();
  for (const Point<2>& point : points) line_.push_back({point[0], point[1], height});
  layer.add_line(
      {.points = line_, .elevation = height, .is_index = levels_.is_index(level, options_.index)});
  report_.points += points.size();
}

/// Returns the bytes of all files.
std::uint64_t ContourFile::write_tiles() {
  std::uint64_t bytes = 0;
  const std::vector<std::size_t> tiles = pieces_->tiles();
  std::vector<std::string> paths = tiling_->paths(tiles);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    VectorLayerOptions layer = layer_;
    layer.path = paths[t];
    tell_lost_layers(format_, layer.path, context());
    VectorFile file(format_, std::move(layer));
    RecordsByTile::Reader records(*pieces_, tiles[t]);
    for (std::vector<std::byte> some; records.next(some);) write_pieces(file.layer(), some);
    file.finish();
    bytes += file.bytes();
  }
  report_.files = tiles.size();
  report_.other_files = tiling_->others_than(std::move(paths));
  report_.spilled_bytes += pieces_->spilled_bytes();
  return bytes;
}

void ContourFile::add_bands() {
  PolygonRings rings;
  bands_->finish([&](const PolygonWithHoles& polygon, std::int64_t band) {
    rings.assign({polygon.outer});
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
    if (pieces_) return add_parts(rings, band);
    add_band(file_->layer(), rings, band);
  });
  report_.spilled_bytes += bands_->stored_bytes();
}

void ContourFile::add_parts(const PolygonRings& polygon, std::int64_t band) {
  bool is_in_a_tile = false;
  tiling_->cut_polygon(polygon, [&](std::size_t tile, const PolygonRings& part) {
    is_in_a_tile = true;
    Packer record;
    record.put(band);
    record.put(part.size());
    for (const auto& ring : part) record.put_list(ring);
    pieces_->add(tile, record.bytes());
  });
  if (!is_in_a_tile) ++report_.outside_tiles;
}

/// What has no level below or above ends at the least or the greatest height of the terrain.
void ContourFile::add_band(VectorLayer& layer, const PolygonRings& polygon, std::int64_t band) {
  const std::vector<std::span<const Point<2>>> rings(polygon.begin(), polygon.end());
  for (const auto& ring : rings) report_.points += ring.size();
  layer.add_band({.rings = rings,
                  .least = levels_.has(band) ? levels_.height(band) : report_.lowest,
                  .greatest = levels_.has(band + 1) ? levels_.height(band + 1) : report_.highest});
  ++report_.polygons;
}

/// Writes what is in records of a tile.
void ContourFile::write_pieces(VectorLayer& layer, std::span<const std::byte> records) {
  if (!bands_) {
    LineStore::for_each(records, [&](std::span<const Point<2>> points, std::int64_t level) {
      add_line(layer, points, level);
    });
    return;
  }
  for (Unpacker parts(records); !parts.empty();) {
    const auto band = parts.take<std::int64_t>();
    PolygonRings rings(parts.take<std::size_t>());
    for (auto& ring : rings) ring = parts.take_list<std::vector<Point<2>>>();
    add_band(layer, rings, band);
  }
}

void ContourFile::number_share(std::uint64_t first_vertex) { writer_->number_from(first_vertex); }

void ContourFile::take_merged(const MergedBlock& block) { writer_->take_merged(block); }

void ContourFile::give_share(ShareSender& sender) { give_contours(*writer_, *lines_, sender); }

void ContourFile::finalize(RunWatch& watch, Report& report, OtherShares& others) {
  ContourStatistics all;
  all.lowest = writer_->lowest();
  all.highest = writer_->highest();
  take_contours(
      *writer_, others,
      [this](std::span<const Point<2>> points, std::int64_t level) { add(points, level); },
      [&all](const ContourStatistics& statistics) {
        all.lowest = std::min(all.lowest, statistics.lowest);
        all.highest = std::max(all.highest, statistics.highest);
        all.lines += statistics.lines;
        all.short_lines += statistics.short_lines;
        all.spilled_bytes += statistics.spilled_bytes;
      });
  writer_->finish(report.mesh);
  all.lines += writer_->lines();
  report_.lines = all.lines;
  report_.short_lines = all.short_lines + writer_->short_lines();
  report_.lowest = std::min(all.lowest, writer_->lowest());
  report_.highest = std::max(all.highest, writer_->highest());
  report_.spilled_bytes = all.spilled_bytes + writer_->spilled_bytes();
  watch.begin("write", bands_ ? "polygons" : "lines");
  if (bands_) add_bands();
  report.output_format = format_.name;
  if (pieces_) {
    report.output_bytes = write_tiles();
  } else {
    file_->finish();
    report.output_bytes = file_->bytes();
  }
  report.write_seconds = watch.end(bands_ ? report_.polygons : report_.lines);
  report.left_out += writer_->left_out();
}

}  // namespace spillway::stream

namespace spillway {

std::unique_ptr<ContourSink> create_contours(const std::string& path, const ContourOptions& options,
                                             const Context& context) {
  return std::make_unique<stream::ContourFile>(path, options, context);
}

}  // namespace spillway
