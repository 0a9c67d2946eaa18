#include <fmt/format.h>

#include <utility>

#include "formats/bytes/buffered_output.h"
#include "formats/bytes/bytes.h"
#include "formats/disk/folder_lock.h"
#include "formats/disk/unfinished_files.h"
#include "formats/meshes/common/checked_mesh_writer.h"
#include "formats/meshes/npy/npy_mesh.h"
#include "formats/points/npy/npy_header.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

/// One array being written.
class ArrayOutput {
 public:
  ArrayOutput(std::unique_ptr<OutputFile> file, std::string type, std::vector<std::uint64_t> shape)
      : output_(std::move(file)) {
    NpyHeader header;
    header.type = std::move(type);
    header.shape = std::move(shape);
    header_ = npy_header_bytes(header, output_.name());
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

class NpyMeshWriter : public CheckedMeshWriter {
 public:
  NpyMeshWriter(MeshFiles files, const MeshHeader& header)
      : CheckedMeshWriter(header, files.main->name()),
        vertices_(std::move(files.main), "<f8", {header.vertices, 3}),
        simplices_(std::move(files.simplices), "<i8", {header.simplices, corners_per_simplex()}) {
    if (header.has_input_index) {
      input_index_.emplace(std::move(files.input_index), "<i8",
                           std::vector<std::uint64_t>{header.vertices});
    }
  }

 private:
  void put_vertices(std::span<const WorldPoint> vertices,
                    std::span<const std::uint64_t> input_index,
                    std::span<const std::byte> /*attributes*/) override {
    vertices_.append(vertices);
    if (input_index_) input_index_->append(input_index);
  }

  void put_simplices(std::span<const std::uint64_t> corners) override {
    simplices_.append(corners);
  }

  void complete() override {
    vertices_.settle();
    simplices_.settle();
    if (input_index_) input_index_->settle();
    const FolderLock lock(name());
    const auto undisturbed = hold_off_end_of_run();
    if (input_index_) input_index_->commit();
    vertices_.commit();
    simplices_.commit();
  }

  ArrayOutput vertices_;
  ArrayOutput simplices_;
  std::optional<ArrayOutput> input_index_;
};

}  // namespace

NpyMeshNames npy_mesh_to_write(const FileSystem& files, const std::string& path,
                               bool has_input_index) {
  if (path == "-") {
    throw InvalidArgument(
        "standard output cannot take an npy mesh, which is two files; choose ply or vtu",
        {.file = path});
  }
  NpyMeshNames names = npy_mesh_names(path);
  if (!has_input_index && files.exists(names.input_index)) {
    throw CannotWrite(names.vertices,
                      fmt::format("{} of an earlier mesh would be taken for part of it; remove it "
                                  "or choose another name",
                                  names.input_index));
  }
  return names;
}

std::unique_ptr<MeshWriter> open_npy_mesh_writer(MeshFiles files, const MeshHeader& header) {
  return std::make_unique<NpyMeshWriter>(std::move(files), header);
}

}  // namespace spillway::detail
