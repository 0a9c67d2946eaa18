#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_format.h"
#include "formats/meshes/common/mesh_stream.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/tiling/mesh_tiles.h"
#include "stream/library/tiling/mesh_tiling.h"

namespace spillway::stream {

/// Where a mesh goes.
struct MeshTarget {
  std::string path;
  const MeshFormat* format = nullptr;
  bool parts = false;  ///< a file for each rank
};

/// As mesh_format() takes path and name; the name of an index (`NAME.pvtu`) means its format in
/// parts. Throws InvalidArgument for no format, and for parts on standard output or in a format
/// that does not stand in parts. Looks at no file.
MeshTarget mesh_target(const std::string& path, const std::string& format_name, bool parts);

/// A mesh file in the making, or one for each tile.
class MeshFile final : public OwnSink<spillway::MeshSink> {
 public:
  /// Throws Failure(kInvalidArgument) as mesh_target(), for parts of one process, and for tiles of
  /// several; and as make_vector_tiling().
  MeshFile(const std::string& path, const MeshFileOptions& options, const Context& context);

  [[nodiscard]] bool is_product() const override { return false; }
  [[nodiscard]] CrsNeed crs_need() const override {
    return target_.format->reads_crs ? CrsNeed::kAll : CrsNeed::kNone;
  }
  [[nodiscard]] AttributeChoice wanted_attributes(bool triangulated) const override;
  void check_attributes(const AttributeLayout& there) const override;
  [[nodiscard]] std::vector<std::string> lost_attributes(const AttributeLayout& there,
                                                         bool triangulated) const override;
  [[nodiscard]] bool tells_hash() const override { return target_.format->has_totals; }
  /// Blocks are written one after the other, and nothing is done before.
  [[nodiscard]] unsigned feeding_threads(unsigned /*threads*/) const override { return 1; }
  /// What has left through a pipe is gone.
  BlockSink* begin_again() override;
  [[nodiscard]] bool can_begin_again() const override;
  void check_periodic(int dimension) const override;
  void finalize(RunWatch& watch, Report& report, OtherShares& others) override;
  void identify(RunIdentity& identity) const override;
  [[nodiscard]] bool goes_on() const override;
  /// Tiles are made of the whole mesh.
  [[nodiscard]] const MeshTarget* as_mesh_file() const override {
    return tiling_ ? nullptr : &target_;
  }
  [[nodiscard]] std::uint64_t own_memory(std::uint64_t limit) const override;

 private:
  BlockSink& open(const MeshStart& start) override;
  BlockSink& open_writer();
  [[nodiscard]] AttributeChoice asked_attributes(bool triangulated) const;

  void check_tiles() const;
  [[nodiscard]] bool is_clipped() const { return !options_.clip.polygons.empty(); }
  void write_tiles(RunWatch& watch, Report& report);

  MeshTarget target_;
  const MeshFileOptions options_;
  std::unique_ptr<MeshTiling> tiling_;  ///< null: one file
  std::shared_ptr<ScratchFolder> scratch_;
  FileSystem* files_ = &disk();
  ScratchFolder* run_scratch_;  ///< this one, or that of a run that can go on
  MeshStreamHeader header_;
  std::unique_ptr<MeshStreamWriter> writer_;
  std::optional<MeshTiles> tiles_;
  const char* simplices_ = "";  ///< what they are called
};

}  // namespace spillway::stream
