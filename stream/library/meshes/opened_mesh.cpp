#include "stream/library/meshes/opened_mesh.h"

#include <fmt/format.h>

#include <span>
#include <utility>
#include <vector>

#include "formats/inputs/open_mesh.h"
#include "formats/inputs/open_mesh_stream.h"
#include "formats/meshes/mesh_formats.h"
#include "src/error.h"
#include "stream/library/choice_check.h"
#include "stream/library/context/context_state.h"
#include "stream/library/given_crs.h"
#include "stream/library/meshes/public_values.h"
#include "stream/library/meshes/whole_mesh.h"
#include "stream/library/points/public_points.h"

namespace spillway::stream {

CheckReport count_stream(MeshStreamReader& reader, const CheckerOptions& options,
                         const std::string& path) {
  CheckReport found = count_mesh_stream(reader, options);
  if (found.fault_count == 0) return found;
  throw Failure(
      fmt::format("{}: {}; the file is corrupt, write it again", path, found.faults.front()),
      ErrorCode::kBadInput, {.file = path});
}

OpenedMesh::OpenedMesh(std::string path, const MeshOptions& options, const Context& context)
    : path_(std::move(path)),
      format_name_(options.format),
      max_expansion_(checked_expansion(options.max_expansion)),
      crs_choice_{checked_crs(options.crs), options.foreign_crs},
      context_(context),
      input_(context_.state().input(path_)) {
  if (!format_name_.empty()) {
    format_ = &mesh_format(path_, format_name_);
    is_stream_ = format_->is_stream();
    return;
  }
  is_stream_ = input_->is_pipe() || kind_of_content(*input_) == formats::ContentKind::kMeshStream;
  if (is_stream_) format_ = &mesh_stream_format(input_->source(), path_);
  input_->release();
}

OpenedMesh::~OpenedMesh() = default;

void OpenedMesh::take() {
  if (std::exchange(is_taken_, true)) {
    throw InvalidArgument(path_ + ": the mesh has been read: open it again");
  }
}

std::unique_ptr<MeshStreamReader> OpenedMesh::open_stream() const {
  return copy_ ? open_mesh_stream_reader(disk(), copy_->name(), format_name_)
               : open_mesh_stream_reader(*input_, path_, format_name_);
}

MeshStreamReader& OpenedMesh::reader(RunWatch& watch, bool all_totals) {
  if (reader_) return *reader_;
  if (is_stream_ && (!all_totals || format_->has_totals)) {
    stream();
    reader_ = std::move(stream_);
    return *reader_;
  }
  if (mesh_) {
    make_reader(*std::exchange(mesh_, std::nullopt), all_totals);
    return *reader_;
  }
  watch.begin("read mesh", "simplices");
  Mesh mesh = stream_ ? collect_mesh(*stream_) : read_whole();
  stream_.reset();
  make_reader(std::move(mesh), all_totals);
  watch.end(reader_->totals().simplices);
  return *reader_;
}

void OpenedMesh::make_reader(Mesh mesh, bool all_totals) {
  const bool had_lattice = mesh.header.lattice.has_value();
  reader_ = std::make_unique<WholeMesh>(std::move(mesh), path_, all_totals);
  drops_lattice_ = had_lattice && !reader_->header().lattice;
}

Mesh OpenedMesh::read_whole() const {
  Mesh mesh = read_mesh(*input_, path_, format_name_, mesh_formats(), max_expansion_);
  for (const std::string& notice : mesh.notices) warn(notice);
  return mesh;
}

void OpenedMesh::warn(const std::string& notice) const {
  if (!context_.options().warning) return;
  context_.options().warning(
      fmt::format("{}: {}", path_ == "-" ? "standard input" : path_, notice));
}

void OpenedMesh::tell_of_dropped_lattice() const {
  if (!drops_lattice_) return;
  warn("a vertex is not on the lattice that the file tells of, which is left out");
}

MeshStreamReader& OpenedMesh::stream() const {
  if (!stream_) stream_ = open_stream();
  return *stream_;
}

const Mesh& OpenedMesh::whole(RunWatch& watch) const {
  if (mesh_) return *mesh_;
  watch.begin("read mesh", "simplices");
  mesh_ = read_whole();
  watch.end(mesh_->corners.size() / mesh_->corners_per_simplex());
  return *mesh_;
}

VertexExtent OpenedMesh::find_extent(RunWatch& watch) {
  if (!is_stream_) {
    reader(watch, false);
    const auto& whole = static_cast<const WholeMesh&>(*reader_);
    return {whole.extent(), whole.totals().vertices};
  }
  keep_copy(watch);
  const std::unique_ptr<MeshStreamReader> reader = open_stream();
  if (reader->header().dimension != 2) return {};
  return find_vertices(*reader, watch);
}

void OpenedMesh::check_totals(RunWatch& watch) {
  if (!is_stream_ || !format_->has_totals) {
    return static_cast<const WholeMesh&>(reader(watch, true)).refuse_crowded_facet(path_);
  }
  keep_copy(watch);
  const std::unique_ptr<MeshStreamReader> reader = open_stream();
  CheckerOptions options;
  options.threads = context_.threads();
  options.progress = [&](std::uint64_t simplices, std::optional<double> fraction) {
    watch.tell(simplices, fraction);
  };
  watch.begin("check totals", "simplices");
  watch.end(count_stream(*reader, options, path_).simplices);
}

void OpenedMesh::keep_copy(RunWatch& watch) {
  if (!input_->is_pipe() || copy_) return;
  if (stream_) {
    throw InvalidArgument(path_ +
                          ": of a mesh from a pipe that is read twice the header cannot be asked "
                          "for beforehand");
  }
  scratch_ = context_.state().scratch(context_);
  copy_ = scratch_->create("mesh");
  const std::unique_ptr<InputFile> pipe = input_->open(path_);
  std::vector<std::byte> piece(std::size_t{1} << 20);
  watch.begin("copy", "bytes");
  while (const std::size_t got = pipe->read(piece)) {
    copy_->append(std::span(piece).first(got));
    watch.tell(copy_->size(), std::nullopt);
  }
  watch.end(copy_->size());
}

MeshStreamReader& OpenedMesh::public_reader() {
  RunWatch watch(context_);
  return reader(watch, true);
}

MeshHeader OpenedMesh::header() const {
  if (reader_) return public_header(reader_->header());
  if (is_stream_) return public_header(stream().header());
  RunWatch watch(context_);
  const Mesh& mesh = whole(watch);
  return {.dimension = mesh.header.dimension,
          .has_input_index = mesh.header.has_input_index,
          .crs = mesh.header.crs,
          .lattice = public_lattice(stream_lattice(mesh)),
          .attributes = mesh.header.attributes.attributes(),
          .periodic = mesh.header.periodic};
}

bool OpenedMesh::read(MeshBlock& block) {
  if (!std::exchange(is_reading_, true)) take();
  MeshStreamReader& reader = public_reader();
  MeshStreamBlock own;
  if (!reader.read(own)) return false;
  const std::uint64_t first = read_;
  read_ += own.vertices.size();
  block = public_block(reader.header(), std::move(own), first);
  return true;
}

spillway::MeshTotals OpenedMesh::totals() { return public_reader().totals(); }

}  // namespace spillway::stream

namespace spillway {

std::unique_ptr<MeshSource> open_mesh(const std::string& path, const MeshOptions& options,
                                      const Context& context) {
  return std::make_unique<stream::OpenedMesh>(path, options, context);
}

}  // namespace spillway
