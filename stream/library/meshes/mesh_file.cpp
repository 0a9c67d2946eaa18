#include "stream/library/meshes/mesh_file.h"

#include <fmt/format.h>

#include "formats/bytes/word_list.h"
#include "formats/disk/extension.h"
#include "formats/disk/file_system.h"
#include "formats/disk/output_check.h"
#include "formats/meshes/common/colour.h"
#include "formats/meshes/create_mesh.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/mesh_stream_writer.h"
#include "formats/meshes/sma/sma_format.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/vector/vector_format.h"
#include "src/geometry/simplex_name.h"
#include "stream/library/context/context_state.h"
#include "stream/library/points/attribute_records.h"
#include "stream/library/points/clip_polygons.h"
#include "stream/library/products/surface_units.h"
#include "stream/library/tiling/clipped_mesh.h"
#include "stream/library/tiling/vector_tiling.h"

namespace spillway::stream {
namespace {

/// The part of the memory that is for what waits for the files of tiles.
constexpr std::uint64_t kTileShare = 8;

}  // namespace

MeshTarget mesh_target(const std::string& path, const std::string& format_name, bool parts) {
  for (const MeshFormat* const format : mesh_formats()) {
    const bool is_index =
        format->part_index != nullptr && extension_of(path) == format->part_index->extension;
    if (is_index && (format_name.empty() || format_name == format->name)) {
      return {path, format, true};
    }
  }
  const MeshFormat& format = mesh_format(path, format_name);
  if (parts && path == "-") {
    throw InvalidArgument("standard output takes no mesh in parts: name a file");
  }
  if (parts && !format.stands_in_parts) {
    const auto stand = [](const MeshFormat& other) { return other.stands_in_parts; };
    throw InvalidArgument(
        fmt::format("a mesh in parts is written as {}, not as {}: choose one of these",
                    list_of_formats(stand, "or"), format.name));
  }
  return {path, &format, parts};
}

namespace {

std::unique_ptr<MeshTiling> make_mesh_tiling(const std::string& path,
                                             const MeshFileOptions& options) {
  check_clip(options.clip);
  const bool has_tiles = options.tile_side != 0 || !options.tile_polygons.empty();
  if (options.clip.polygons.empty()) {
    return make_vector_tiling(path, options.tile_side, options.tile_polygons);
  }
  if (has_tiles) throw InvalidArgument("a mesh is clipped, or cut into tiles, not both");
  return std::make_unique<ClippedMesh>(path, options.clip);
}

}  // namespace

MeshFile::MeshFile(const std::string& path, const MeshFileOptions& options, const Context& context)
    : OwnSink(context),
      target_(mesh_target(path, options.format, options.parts)),
      options_(options),
      tiling_(make_mesh_tiling(path, options)),
      scratch_(context.state().scratch(context)),
      run_scratch_(scratch_.get()) {
  if (target_.parts && context.options().executor == nullptr) {
    throw InvalidArgument("parts are a file for each rank, and there is one process",
                          {.remedy = Remedy::kRanks});
  }
  if (tiling_) check_tiles();
  if (!tiling_ && target_.format == &kGpkgMesh)
    tell_lost_layers(kGeoPackage, target_.path, context);
}

void MeshFile::check_tiles() const {
  if (context().options().executor != nullptr) {
    throw InvalidArgument(
        "tiles of a mesh, and one that is clipped, are written by one process: let several write "
        "one mesh, and convert that");
  }
  if (target_.path != "-") check_can_create(target_.path);
}

/// As if the format held all.
AttributeChoice MeshFile::asked_attributes(bool triangulated) const {
  if (options_.attributes) return attribute_choice(*options_.attributes);
  if (!triangulated) return {.all = true};
  return target_.format->takes_colour ? colour_choice() : AttributeChoice{};
}

AttributeChoice MeshFile::wanted_attributes(bool triangulated) const {
  const AttributeChoice asked = asked_attributes(triangulated);
  if (target_.format->held_attributes == HeldAttributes::kAll) return asked;
  if (target_.format->held_attributes == HeldAttributes::kNone) return {};
  return asked.empty() ? asked : colour_choice();
}

void MeshFile::check_attributes(const AttributeLayout& there) const {
  if (!options_.attributes) return;
  refuse_unknown_names(*options_.attributes, there);
  const AttributeChoice named{.names = attribute_choice(*options_.attributes).names};
  const std::vector<std::string> lost =
      formats::lost_attributes(*target_.format, chosen(there, named));
  if (lost.empty()) return;
  const auto hold_all = [](const MeshFormat& format) {
    return format.held_attributes == HeldAttributes::kAll;
  };
  throw InvalidArgument(fmt::format("vertices of {} do not hold {}: write {}",
                                    target_.format->title, word_list(lost, "and"),
                                    list_of_formats(hold_all, "or")));
}

std::vector<std::string> MeshFile::lost_attributes(const AttributeLayout& there,
                                                   bool triangulated) const {
  return formats::lost_attributes(*target_.format, chosen(there, asked_attributes(triangulated)));
}

BlockSink& MeshFile::open(const MeshStart& start) {
  simplices_ = simplices_of(start.header.dimension);
  header_ = start.header;
  if (start.files != nullptr) files_ = start.files;
  if (start.scratch != nullptr) run_scratch_ = start.scratch;
  if (tiling_ && !options_.foreign_crs) {
    const std::string& polygons =
        options_.clip.polygons.empty() ? options_.tile_polygons : options_.clip.polygons;
    check_same_crs(start.name, header_.crs, polygons, tiling_->crs(), polygons);
  }
  return open_writer();
}

std::uint64_t MeshFile::own_memory(std::uint64_t limit) const {
  return tiling_ ? limit / kTileShare : 0;
}

BlockSink& MeshFile::open_writer() {
  if (tiling_) {
    check_holds(*target_.format, target_.path, contents_of(header_));
    const std::uint64_t memory = own_memory(context().memory());
    return tiles_.emplace(header_, *tiling_, memory, *run_scratch_).blocks();
  }
  writer_.reset();
  writer_ = open_mesh_stream_writer(*files_, target_.path, *target_.format, header_, *run_scratch_);
  return *writer_;
}

void MeshFile::identify(RunIdentity& identity) const {
  identify_product(target_.format->name, target_.path, identity);
}

/// What is spooled, and streams of blocks that are written from front to back.
bool MeshFile::goes_on() const {
  if (tiling_) return false;
  return target_.format->open_block_writer == nullptr || target_.format == &kSpmMesh ||
         target_.format == &kSmaMesh;
}

bool MeshFile::can_begin_again() const { return tiling_ || can_be_tried(target_.path); }

void MeshFile::check_periodic(int dimension) const {
  if (tiling_) {
    throw InvalidArgument("a periodic mesh is not written in tiles or clipped: write one file");
  }
  if (target_.format->holds_offsets) return;
  const auto hold = [](const MeshFormat& other) { return other.holds_offsets; };
  throw InvalidArgument(
      fmt::format("{} cannot hold a periodic mesh, whose {} cross the sides of the box; choose {}",
                  target_.format->title, simplices_of(dimension), list_of_formats(hold, "or")),
      {.file = target_.path});
}

BlockSink* MeshFile::begin_again() {
  if (!can_begin_again()) return nullptr;
  header_.extent.reset();  // headers of points have told it
  return &open_writer();
}

void MeshFile::finalize(RunWatch& watch, Report& report, OtherShares& /*others*/) {
  watch.begin("write", simplices_);
  report.output_format = target_.format->name;
  if (tiles_) {
    write_tiles(watch, report);
    report.write_seconds = watch.end(report.mesh.simplices);
    return;
  }
  writer_->finish(report.mesh);
  report.output_bytes = writer_->bytes_written();
  writer_.reset();
  report.write_seconds = watch.end(report.mesh.simplices);
}

void MeshFile::write_tiles(RunWatch& watch, Report& report) {
  MeshTiles::Written written = tiles_->write(*target_.format, is_clipped(), context(), watch);
  if (written.paths.empty() && is_clipped()) {
    throw Failure(fmt::format("none of the {} lies where {} says, so nothing is written",
                              simplices_, options_.clip.polygons),
                  ErrorCode::kInvalidArgument);
  }
  report.output_bytes = written.bytes;
  report.output_files = written.paths.size();
  report.outside_tiles = tiles_->outside();
  report.outside_vertices = report.mesh.vertices - tiles_->vertices();
  if (is_clipped()) {
    report.mesh.vertices = written.totals.vertices;
    report.mesh.simplices = written.totals.simplices;
    report.mesh.hull_facets = written.totals.hull_facets;
    report.mesh.canonical_hash = written.totals.canonical_hash;
  }
  report.other_files = tiling_->others_than(std::move(written.paths));
  tiles_.reset();
}

}  // namespace spillway::stream

namespace spillway {

std::unique_ptr<MeshSink> create_mesh(const std::string& path, const MeshFileOptions& options,
                                      const Context& context) {
  return std::make_unique<stream::MeshFile>(path, options, context);
}

}  // namespace spillway
