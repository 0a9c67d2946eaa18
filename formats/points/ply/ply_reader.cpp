#include "formats/points/ply/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "formats/ply/ply_values.h"
#include "formats/points/ply/ply_cloud.h"
#include "formats/points/rows/row_reader.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// Vertices that are read value by value: of text, or with lists in them.
template <typename Values>
class ValueRows : public RowSource {
 public:
  /// `values` are those after the header.
  ValueRows(PlyCloud cloud, Values values) : cloud_(std::move(cloud)), values_(std::move(values)) {}

  std::size_t read(std::span<std::byte> rows) override {
    if (next_ == 0) pass_over_elements(0, cloud_.vertices);
    for (std::byte* at = rows.data(); at != rows.data() + rows.size();) at = read_row(at);
    return rows.size();
  }

  void finish() override {
    if (cloud_.vertex().count == 0) pass_over_elements(0, cloud_.vertices);
    pass_over_elements(cloud_.vertices + 1, cloud_.header.elements.size());
    values_.finish();
  }

 private:
  void go_to(std::uint64_t /*row*/) override {}

  void pass_over_elements(std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) pass_over(values_, cloud_.header.elements[i]);
  }

  std::byte* read_row(std::byte* at) {
    const PlyElement& vertex = cloud_.vertex();
    values_.begin_item(vertex.name, next_++);
    for (const PlyProperty& property : vertex.properties) {
      if (property.length_type) {
        pass_over(values_, property);
        continue;
      }
      read_number(values_, property, at);
      at += size_of(property.type);
    }
    values_.end_item();
    return at;
  }

  PlyCloud cloud_;
  Values values_;
  std::uint64_t next_ = 0;  // number of the vertex
};

/// Makes sure that the file has room for all vertices.
void check_room(const InputBytes& source, const PlyCloud& cloud) {
  const std::optional<std::uint64_t> size = source.size();
  if (!size) return;
  // The end of the last line of text may be missing.
  const std::uint64_t room = *size + 1 - std::min(*size, source.position());
  const std::uint64_t count = cloud.vertex().count;
  if (count <= room / cloud.smallest_vertex()) return;
  throw BadInput(
      source.name(),
      fmt::format("the header says {} points, but the file ends at byte {}, which leaves "
                  "room for at most {}; get a complete copy",
                  count, *size, room / cloud.smallest_vertex()),
      at_byte(*size));
}

}  // namespace

std::unique_ptr<PointReader> open_ply_points(std::unique_ptr<InputBytes> source,
                                             const std::string& path, bool skip_invalid) {
  PlyCloud cloud = ply_cloud(read_ply_header(*source), source->name());
  RowFile file{.row = cloud.row, .header = {}};
  file.header.name = path;
  file.header.format = "ply";
  file.header.version = "1.0";
  file.header.count = cloud.vertex().count;
  file.header.crs = cloud.crs;
  file.header.notices = cloud.notices;
  file.skip_invalid = skip_invalid;
  if (cloud.bytes_before) {
    file.behind = cloud.bytes_behind;
    if (!source->skip(*cloud.bytes_before)) {
      throw BadInput(source->name(),
                     fmt::format("the file ends at byte {}, before its points; get a complete copy",
                                 source->position()),
                     at_byte(source->position()));
    }
  } else {
    check_room(*source, cloud);
    file.has_fixed_size = false;
    const std::uint64_t lines = cloud.header.lines;
    const bool swap = cloud.header.encoding == PlyEncoding::kBigEndian;
    if (cloud.header.encoding == PlyEncoding::kAscii) {
      file.rows = std::make_unique<ValueRows<PlyTextValues>>(std::move(cloud),
                                                             PlyTextValues(*source, lines));
    } else {
      file.rows = std::make_unique<ValueRows<PlyBinaryValues>>(std::move(cloud),
                                                               PlyBinaryValues(*source, swap));
    }
  }
  file.source = std::move(source);
  return open_row_reader(std::move(file));
}

}  // namespace spillway::formats
