// Every format of points: as a file, in pieces, with all attributes; and as a pipe, with all that
// helps to read damaged files.

#include <cmath>
#include <cstdint>
#include <memory>

#include "formats/inputs/open_points.h"
#include "formats/points/point_formats.h"
#include "tests/faulty_file_system.h"
#include "tests/fuzz/block_repair.h"
#include "tests/fuzz/seeds.h"
#include "tests/fuzz/target.h"
#include "tests/fuzz/zstd_window.h"

namespace spillway::test {
namespace {

/// What blocks have to be, whatever is read.
void check_block(const PointBlock& block, std::size_t record_size) {
  expect_kept(block.index.size() == block.points.size(), "each point has an index");
  expect_kept(block.attributes.empty() || block.attributes.size() == record_size * block.size(),
              "each point has a record of attributes");
  for (const LatticePoint& point : block.points) {
    for (int k = 0; k < 3; ++k) expect_kept(std::isfinite(point[k]), "coordinates are finite");
  }
}

/// All records from front to back, or those of a piece.
std::uint64_t read_blocks(PointReader& reader, std::size_t record_size) {
  std::uint64_t records = 0;
  PointBlock block;
  bool more = true;
  while (more) {
    more = reader.read(block);
    check_block(block, record_size);
    records += block.size() + block.withheld + block.invalid;
  }
  return records;
}

/// Reads points as the options say; the pieces, too, where they can be read apart.
void read_points(FaultyFileSystem& files, const std::string& path,
                 const PointReaderOptions& options) {
  const auto open = [&] {
    std::unique_ptr<PointReader> reader = open_point_reader(files, path, options);
    reader->carry(reader->header().attributes);
    return reader;
  };
  const auto whole = open();
  const PointHeader& header = whole->header();
  const std::size_t record_size = header.attributes.record_size();
  const std::uint64_t records = read_blocks(*whole, record_size);
  const bool all = !options.salvage && !options.bounds && options.resolution == 0;
  if (all && header.count) expect_kept(records == *header.count, "the header tells the count");
  const std::optional<std::uint64_t> pieces = whole->pieces();
  if (!pieces || *pieces > 100) return;
  const auto apart = open();
  std::uint64_t in_pieces = 0;
  for (std::uint64_t piece = *pieces; piece-- > 0;) {
    apart->begin_piece(piece);
    in_pieces += read_blocks(*apart, record_size);
  }
  expect_kept(in_pieces == records, "all pieces are all points");
}

void read_in_many_ways(const PointFormat& format, std::string_view bytes) {
  if (format.is_text && has_large_zstd_window(bytes)) return;
  const std::string path = "a." + std::string(format.extensions.front());
  FaultyFileSystem files;
  files.files[path] = bytes;
  PointReaderOptions options;
  options.format = format.name;
  options.keep_withheld = options.skip_invalid = true;
  options.salvage = format.las_variant != nullptr;
  files.seekable = false;
  try {
    read_points(files, path, options);
  } catch (const Failure&) {
    // Some are not read from pipes at all.
  }
  files.seekable = files.read_anywhere = true;
  if (format.has_levels) {
    try {
      read_points(files, path,
                  {.format = std::string(format.name),
                   .bounds = Box<3>{{5e5, 4e6, -1e9}, {5e5 + 30, 4e6 + 50, 1e9}},
                   .resolution = 2});
    } catch (const Failure&) {
      // As above.
    }
  }
  read_points(files, path, {.format = std::string(format.name), .metadata = true});
}

}  // namespace

std::vector<FuzzTarget> point_targets() {
  std::vector<FuzzTarget> targets;
  for (const PointFormat* const format : point_formats()) {
    if (format->name == "raster") continue;  // which GDAL reads, from the disk
    targets.push_back({std::string(format->name),
                       [format](std::string_view bytes) {
                         if (*format == own_point_stream()) {
                           read_in_many_ways(*format, with_right_checksums(bytes));
                         } else {
                           read_in_many_ways(*format, bytes);
                         }
                       },
                       [format] { return point_seeds(*format); }});
  }
  return targets;
}

}  // namespace spillway::test
