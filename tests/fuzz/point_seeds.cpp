#include <fmt/format.h>

#include "formats/points/create_points.h"
#include "formats/points/point_formats.h"
#include "tests/formats/points/copc/copc_file.h"
#include "tests/formats/points/las/las_file.h"
#include "tests/formats/points/laz/laz_encoder/laz_file.h"
#include "tests/formats/points/laz/laz_encoder/random_records.h"
#include "tests/fuzz/block_repair.h"
#include "tests/fuzz/seeds.h"

namespace spillway::test {
namespace {

constexpr std::size_t kPoints = 40;

AttributeLayout some_attributes(const PointFormat& format) {
  if (!format.holds_attributes) return {};
  return AttributeLayout({{.name = "intensity", .type = NumberType::kUint16},
                          {.name = "gps_time", .type = NumberType::kFloat64},
                          {.name = "pair", .type = NumberType::kInt16, .elements = 2}});
}

std::string written_points(const PointFormat& format, PointWriterOptions options) {
  FaultyFileSystem files;
  const std::string path = "a." + std::string(format.extensions.front());
  options.format = format.name;
  options.count = kPoints;
  if (format.needs_lattice) options.lattice = IntegerLattice{{0.01, 0.01, 0.01}, {500000, 4e6, 0}};
  const auto writer = open_point_writer(files, path, options);
  std::vector<LatticePoint> points;
  std::vector<std::byte> records(kPoints * options.attributes.record_size());
  for (std::size_t i = 0; i < kPoints; ++i) {
    points.emplace_back(double(i * 37 % 101), double(i * 11 % 17), double(i % 5));
  }
  for (std::size_t i = 0; i < records.size(); ++i) records[i] = static_cast<std::byte>(i % 7);
  writer->write(points, records);
  writer->finish();
  return files.files.begin()->second;
}

std::vector<std::string> las_files() {
  std::vector<std::string> files;
  for (const int point_format : {0, 1, 3, 5, 6, 8, 10}) {
    LasFile file;
    file.point_format = point_format;
    file.minor = point_format >= 6 ? 4 : point_format >= 4 ? 3 : 2;
    file.extra_bytes = point_format % 2 == 0 ? 5 : 0;
    file.vlrs = {{"LASF_Projection", 2112, "GEOGCS[\"a\"]"},
                 {"LASF_Projection", 34735, std::string("\1\0\1\0\0\0\1\0\0\4\0\0\1\0\1\0", 16)}};
    if (file.extra_bytes > 0) {
      std::string described(192, '\0');
      described.replace(2, 2, std::string("\5\0", 2));
      described.replace(4, 5, "extra");
      file.vlrs.push_back({"LASF_Spec", 4, described});
    }
    files.push_back(file.bytes());
  }
  return files;
}

std::vector<std::string> laz_files() {
  std::vector<std::string> files;
  for (const int point_format : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
    for (const bool streamed : {false, true}) {
      LazFormat format;
      format.point_format = point_format;
      format.extra_bytes = point_format % 3;
      format.compressor = point_format >= 6 ? 3 : streamed ? 1 : 2;
      format.version = point_format >= 6 ? 3 : streamed ? 1 : 2;
      format.chunk_size = 15;
      LazFile file =
          make_laz_file(format, RandomRecords{point_format, format.extra_bytes, 40, 7}.make());
      if (streamed && format.compressor > 1) file.table_place = LazFile::Table::kStreamed;
      files.push_back(file.bytes());
    }
  }
  return files;
}

std::string copc_file() {
  CopcFile file;
  file.pages.push_back({0, {1, 1, 0, 0}});
  file.nodes = {{{0, 0, 0, 0}, 10}, {{1, 0, 0, 0}, 8}, {{1, 1, 0, 0}, 6, 1}, {{2, 2, 1, 0}, 0, 1}};
  file.build();
  return file.bytes();
}

/// With regions, of which a header tells the boxes.
std::string with_regions(const PointFormat& format) {
  FaultyFileSystem files;
  PointWriterOptions options;
  options.format = format.name;
  options.by_regions = true;
  const auto writer = open_point_writer(files, "a", options);
  const std::vector<PointRegion> regions = {{{{0, 0, 0}, {1, 1, 1}}, 2},
                                            {{{2, 0, 0}, {3, 3, 3}}, 1}};
  writer->set_regions(regions);
  writer->write(std::vector<LatticePoint>{{0, 0, 0}, {1, 1, 1}, {2, 3, 1}}, {});
  writer->finish();
  return files.files.at("a");
}

}  // namespace

std::vector<std::string> point_seeds(const PointFormat& format) {
  std::vector<std::string> seeds = foreign_points(format.name);
  if (format.name == "las") seeds = las_files();
  if (format.name == "laz") seeds = laz_files();
  if (format.name == "copc") seeds = {copc_file()};
  if (format.open_writer == nullptr) return seeds;
  seeds.push_back(written_points(format, {}));
  seeds.push_back(written_points(format, {.crs = format.wants_wkt ? "" : "EPSG:25832",
                                          .attributes = some_attributes(format)}));
  if (!format.needs_lattice) {
    seeds.push_back(written_points(format, {.lattice = IntegerLattice{}}));
    seeds.push_back(written_points(format, {.coordinates = 2}));
  }
  if (format.has_versions && !format.wants_wkt) {
    for (const char* const version : {"1.2", "1.4"}) {
      seeds.push_back(written_points(format, {.version = version}));
    }
  }
  if (format.holds_regions) seeds.push_back(with_regions(format));
  if (format == own_point_stream()) {
    const std::size_t written = seeds.size();
    for (std::size_t i = 0; i < written; ++i) seeds.push_back(with_plain_blocks(seeds[i]));
  }
  return seeds;
}

}  // namespace spillway::test
