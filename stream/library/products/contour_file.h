#pragma once

#include <spillway/contours.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/vectors/vector_file.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/tiling/records_by_tile.h"
#include "stream/library/tiling/vector_tiling.h"
#include "stream/sinks/band_store.h"
#include "stream/sinks/contour_writer.h"
#include "stream/sinks/line_store.h"

namespace spillway::stream {

/// A vector file of contours in the making.
class ContourFile final : public OwnSink<ContourSink> {
 public:
  ContourFile(const std::string& path, const ContourOptions& options, const Context& context);

  void identify(RunIdentity& identity) const override {
    identify_product("contours", path_, identity);
  }
  [[nodiscard]] const ContourReport& report() const override { return report_; }

  [[nodiscard]] CrsNeed crs_need() const override { return CrsNeed::kAll; }
  [[nodiscard]] std::uint64_t own_memory(std::uint64_t limit) const override;
  BlockSink* begin_again() override;
  [[nodiscard]] bool has_shares() const override { return true; }
  void number_share(std::uint64_t first_vertex) override;
  void take_merged(const MergedBlock& block) override;
  void give_share(ShareSender& sender) override;
  void finalize(RunWatch& watch, Report& report, OtherShares& others) override;

 private:
  BlockSink& open(const MeshStart& start) override;

  [[nodiscard]] bool keeps_coordinates(const MeshStart& start) const;
  void add(std::span<const Point<2>> points, std::int64_t level);

  void add_line(VectorLayer& layer, std::span<const Point<2>> points, std::int64_t level);
  void add_pieces(std::span<const Point<2>> points, std::int64_t level);
  [[nodiscard]] std::uint64_t memory_of_pieces() const;
  void add_bands();
  void add_parts(const PolygonRings& polygon, std::int64_t band);
  void add_band(VectorLayer& layer, const PolygonRings& polygon, std::int64_t band);
  void write_pieces(VectorLayer& layer, std::span<const std::byte> records);
  [[nodiscard]] std::uint64_t write_tiles();

  std::string path_;
  const VectorFormat& format_;
  ContourOptions options_;
  Levels levels_;
  std::unique_ptr<VectorTiling> tiling_;  ///< null: one file
  std::shared_ptr<ScratchFolder> scratch_;
  VectorLayerOptions layer_;
  ContourSinkOptions contours_;
  bool writes_file_;                     ///< or another process does
  std::optional<VectorFile> file_;       ///< of who writes it
  std::optional<RecordsByTile> pieces_;  ///< of who writes tiles
  std::optional<LineStore> lines_;       ///< of the others
  std::optional<BandStore> bands_;       ///< of who writes bands
  std::optional<ContourWriter> writer_;
  std::vector<WorldPoint> line_;
  ContourReport report_;
};

}  // namespace spillway::stream
