#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "formats/bytes/buffered_output.h"
#include "formats/bytes/bytes.h"
#include "formats/disk/folder_lock.h"
#include "formats/disk/unfinished_files.h"
#include "formats/meshes/common/checked_mesh_writer.h"
#include "formats/meshes/common/vertex_records.h"
#include "formats/meshes/npy/npy_mesh.h"
#include "formats/points/attributes/further_coordinates.h"
#include "formats/points/attributes/unique_names.h"
#include "formats/points/npy/npy_fields.h"
#include "formats/points/npy/npy_header.h"
#include "formats/points/rows/row_encoder.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// One array being written.
class ArrayOutput {
 public:
  ArrayOutput(std::unique_ptr<OutputFile> file, const NpyHeader& header)
      : header_(npy_header_bytes(header, file->name())), output_(std::move(file)) {
    output_.append(header_);
  }

  template <typename T>
  void append(std::span<const T> values) {
    output_.append(as_text(std::as_bytes(values)));
  }

  /// Brings everything to the disk, where it may still fail, before any file gets its name: an
  /// output that is rewritten must have written what it buffers.
  void settle() { output_.rewrite(0, header_); }

  void commit() { output_.commit(); }

 private:
  std::string header_;
  BufferedOutput output_;
};

NpyHeader array_of(std::string type, std::vector<std::uint64_t> shape) {
  NpyHeader header;
  header.type = std::move(type);
  header.shape = std::move(shape);
  return header;
}

std::uint64_t columns_of(const MeshFileHeader& header) {
  return std::uint64_t(std::max(kOwnAxes, header.dimension));
}

/// A structured array, whose elements have a field for each attribute.
NpyHeader array_of_records(const AttributeLayout& layout, std::uint64_t count) {
  NpyHeader header = array_of("structure", {count});
  UniqueNames names;
  append_npy_fields(header.fields, layout, names);
  return header;
}

class NpyMeshWriter : public CheckedMeshWriter {
 public:
  NpyMeshWriter(MeshFiles files, const MeshFileHeader& header)
      : CheckedMeshWriter(header, files.main->name()),
        vertices_(std::move(files.main), array_of("<f8", {header.vertices, columns_of(header)})),
        simplices_(std::move(files.simplices),
                   array_of("<i8", {header.simplices, corners_per_simplex()})),
        records_(header,
                 without_scales(without_further_coordinates(header.attributes, header.dimension))) {
    if (header.has_input_index) {
      input_index_.emplace(std::move(files.input_index), array_of("<i8", {header.vertices}));
    }
    if (!records_.layout().empty()) {
      attributes_.emplace(std::move(files.attributes),
                          array_of_records(records_.layout(), header.vertices));
    }
    if (header.periodic) {
      const auto axes = static_cast<std::uint64_t>(header.dimension);
      offsets_.emplace(std::move(files.offsets),
                       array_of("|i1", {header.simplices, corners_per_simplex(), axes}));
      box_.emplace(std::move(files.box), array_of("<f8", {2, axes}));
      put_box(*header.periodic);
    }
  }

 private:
  void put_vertices(std::span<const WorldPoint> vertices,
                    std::span<const std::uint64_t> input_index,
                    std::span<const std::byte> attributes) override {
    put_coordinates(vertices, attributes);
    if (input_index_) input_index_->append(input_index);
    if (attributes_) attributes_->append(records_.convert(attributes, 0));
  }

  /// A row of all coordinates for each vertex.
  void put_coordinates(std::span<const WorldPoint> vertices, std::span<const std::byte> records) {
    if (further_axes(header().dimension) == 0) return vertices_.append(vertices);
    const std::size_t record_size = header().attributes.record_size();
    const std::size_t further = further_axes(header().dimension) * sizeof(double);
    rows_.clear();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const auto own = std::as_bytes(std::span(vertices[v]));
      rows_.insert(rows_.end(), own.begin(), own.end());
      const auto beyond = records.subspan(v * record_size, further);
      rows_.insert(rows_.end(), beyond.begin(), beyond.end());
    }
    vertices_.append(std::span<const std::byte>(rows_));
  }

  void put_simplices(std::span<const std::uint64_t> corners) override {
    simplices_.append(corners);
  }

  void put_offsets(std::uint64_t first_corner, std::span<const CornerOffset> offsets) override {
    put_none_before(first_corner);
    periods_.clear();
    for (const CornerOffset offset : offsets) {
      for (int k = 0; k < header().dimension; ++k) {
        periods_.push_back(static_cast<std::int8_t>(periods_along(offset, k)));
      }
    }
    offsets_->append(std::span<const std::int8_t>(periods_));
    corners_ += offsets.size();
  }

  /// Corners that got no offset have none.
  void put_none_before(std::uint64_t corner) {
    constexpr std::uint64_t kPiece = 4096;
    const std::array<std::int8_t, kPiece * 3> none{};
    while (corners_ < corner) {
      const std::uint64_t some = std::min(corner - corners_, kPiece);
      offsets_->append(
          std::span(none).first(some * static_cast<std::uint64_t>(header().dimension)));
      corners_ += some;
    }
  }

  /// Open axes go on without end.
  void put_box(const PeriodicBox& box) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<double> sides;
    for (int k = 0; k < header().dimension; ++k) {
      sides.push_back(box.periodic[k] ? box.box.low[k] : -kInfinity);
    }
    for (int k = 0; k < header().dimension; ++k) {
      sides.push_back(box.periodic[k] ? box.box.high[k] : kInfinity);
    }
    box_->append(std::span<const double>(sides));
  }

  void complete() override {
    if (offsets_) put_none_before(header().simplices * corners_per_simplex());
    vertices_.settle();
    simplices_.settle();
    if (input_index_) input_index_->settle();
    if (attributes_) attributes_->settle();
    if (offsets_) offsets_->settle();
    if (box_) box_->settle();
    const FolderLock lock(name());
    const auto undisturbed = hold_off_end_of_run();
    if (input_index_) input_index_->commit();
    if (attributes_) attributes_->commit();
    if (offsets_) offsets_->commit();
    if (box_) box_->commit();
    vertices_.commit();
    simplices_.commit();
  }

  ArrayOutput vertices_;
  std::vector<std::byte> rows_;  ///< of vertices that are being written
  ArrayOutput simplices_;
  std::optional<ArrayOutput> input_index_;
  VertexRecords records_;
  std::optional<ArrayOutput> attributes_;
  std::optional<ArrayOutput> offsets_;
  std::uint64_t corners_ = 0;         ///< whose offsets have been written
  std::vector<std::int8_t> periods_;  ///< of corners that are being written
  std::optional<ArrayOutput> box_;
};

}  // namespace

NpyMeshNames npy_mesh_to_write(const FileSystem& files, const std::string& path,
                               const MeshContents& contents) {
  if (path == "-") {
    throw InvalidArgument(
        "standard output cannot take an npy mesh, which is two files; choose ply or vtu",
        {.file = path});
  }
  NpyMeshNames names = npy_mesh_names(path);
  const auto refuse_earlier = [&](const std::string& file) {
    if (!files.exists(file)) return;
    throw CannotWrite(names.vertices,
                      fmt::format("{} of an earlier mesh would be taken for part of it; remove it "
                                  "or choose another name",
                                  file));
  };
  if (!contents.has_input_index) refuse_earlier(names.input_index);
  if (!contents.has_attributes) refuse_earlier(names.attributes);
  if (!contents.is_periodic) {
    refuse_earlier(names.offsets);
    refuse_earlier(names.box);
  }
  return names;
}

std::unique_ptr<MeshWriter> open_npy_mesh_writer(MeshFiles files, const MeshFileHeader& header) {
  return std::make_unique<NpyMeshWriter>(std::move(files), header);
}

}  // namespace spillway::formats
