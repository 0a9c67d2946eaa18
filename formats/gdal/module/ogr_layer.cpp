// Vector layers that are written.

#include <fmt/format.h>
#include <ogrsf_frmts.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "formats/gdal/module/crs.h"
#include "formats/gdal/module/dxf_template.h"
#include "formats/gdal/module/gdal_errors.h"
#include "formats/gdal/vector_drivers.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::uint64_t kFeaturesPerTransaction = 100'000;
constexpr std::uint64_t kFeaturesPerLook = 64;  ///< at the disk's free space
constexpr const char* kElevation = "elevation";
constexpr const char* kIndex = "index";
constexpr const char* kLeast = "min";
constexpr const char* kGreatest = "max";

// Layers of DXF, by the field in which its driver takes them.
constexpr const char* kDxfLayer = "Layer";
constexpr const char* kIndexLayer = "CONTOUR-INDEX";
constexpr const char* kIntermediateLayer = "CONTOUR-INTERMEDIATE";

// A shapefile's parts may not pass 2 GB, for many programs count their bytes in signed 32 bits. A
// record of .shp has 8 bytes before it; of a line or polygon with z it has a box, two counts, one
// part, and for each point x, y, z; with the ranges of z (ESRI Shapefile Technical Description,
// 1998, p. 16).
constexpr std::uint64_t kShapefileLimit = (std::uint64_t{1} << 31) - 1;
constexpr std::uint64_t kShapefileHeader = 100;
constexpr std::uint64_t kShapefileRecord = 8 + 4 + 32 + 4 + 4 + 4 + 16;
constexpr std::uint64_t kShapefilePart = 4;
constexpr std::uint64_t kShapefilePoint = 24;

OGRwkbGeometryType geometry_of(VectorContent content) {
  switch (content) {
    case VectorContent::kLines:
      return wkbLineString25D;
    case VectorContent::kBands:
      return wkbPolygon;
    default:
      return wkbPolygon25D;
  }
}

/// Bytes that still fit on the disk where a file lies, as far as that is known.
std::uint64_t free_bytes(const std::string& path) {
  struct statvfs disk {};
  if (::statvfs(path.c_str(), &disk) != 0) return std::numeric_limits<std::uint64_t>::max();
  return (::geteuid() == 0 ? disk.f_bfree : disk.f_bavail) * std::uint64_t{disk.f_frsize};
}

bool disk_is_full(const std::string& path) { return free_bytes(path) == 0; }

/// Bytes that a file may have.
std::uint64_t largest_file() {
  rlimit limit{};
  const bool known = ::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  return known ? limit.rlim_cur : std::numeric_limits<std::uint64_t>::max();
}

/// Whether the last word of a text file ends so.
bool ends_with(const std::string& path, std::string_view end) {
  constexpr std::streamoff kMost = 64;  // of which a driver's last line has less
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg();
  if (size < 0) return false;
  std::string last(static_cast<std::size_t>(std::min(size, kMost)), ' ');
  file.seekg(size - static_cast<std::streamoff>(last.size()));
  file.read(last.data(), static_cast<std::streamsize>(last.size()));
  while (!last.empty() && std::isspace(static_cast<unsigned char>(last.back())) != 0) {
    last.pop_back();
  }
  return std::string_view(last).ends_with(end);
}

/// A coordinate whose unit is not known. One of 1000 and more is none of degrees: 3 decimals are
/// enough. The driver writes 7.
double rounded(double coordinate) {
  constexpr double kNoDegrees = 1e3;
  constexpr double kMost = 1e12;  // what has no such digits stays as it is
  const double size = std::abs(coordinate);
  return size >= kNoDegrees && size < kMost ? std::round(coordinate * 1000) / 1000 : coordinate;
}

class OgrLayer : public VectorLayer {
 public:
  explicit OgrLayer(const VectorLayerOptions& options)
      : name_(options.name),
        path_(options.path),
        is_shapefile_(options.driver == "ESRI Shapefile"),
        is_json_(options.driver == "GeoJSON"),
        is_dxf_(options.driver == "DXF"),
        is_rounded_(is_json_ && options.as_they_are) {
    forget_gdal_errors();
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(options.driver.c_str());
    if (driver == nullptr) fail("GDAL is installed without its driver " + options.driver);
    std::string header;
    if (is_dxf_) {
      check_room_for_dxf();
      dxf_template_ = std::make_unique<DxfTemplate>(options.name, options.crs);
      header = "HEADER=" + dxf_template_->path();
    }
    std::array<const char*, 2> how = {is_dxf_ ? header.c_str() : nullptr, nullptr};
    file_.reset(
        driver->Create(options.path.c_str(), 0, 0, 0, GDT_Unknown, const_cast<char**>(how.data())));
    if (!file_) fail(gdal_reason());
    create_layer(options);
    forget_gdal_errors();
    in_transaction_ = file_->StartTransaction() == OGRERR_NONE;  // not every driver has them
    forget_gdal_errors();
  }

  ~OgrLayer() override {
    if (is_dxf_ && file_) drop_dxf_entities();
  }
  OgrLayer(const OgrLayer&) = delete;
  OgrLayer& operator=(const OgrLayer&) = delete;

  void add_triangle(std::span<const WorldPoint, 3> corners) override {
    take_space(4);
    OGRLinearRing ring;
    ring.setNumPoints(4, FALSE);
    for (int i = 0; i < 4; ++i) {
      const WorldPoint& corner = corners[i % 3];
      ring.setPoint(i, corner[0], corner[1], corner[2]);
    }
    OGRPolygon polygon;
    polygon.addRing(&ring);
    OGRFeature feature(layer_->GetLayerDefn());
    feature.SetGeometry(&polygon);
    add(feature);
  }

  void add_line(const ContourLine& line) override {
    take_space(line.points.size());
    OGRFeature feature(layer_->GetLayerDefn());
    if (is_dxf_) {
      feature.SetField(kDxfLayer, line.is_index ? kIndexLayer : kIntermediateLayer);
    } else {
      feature.SetField(kElevation, line.elevation);
      feature.SetField(kIndex, line.is_index ? 1 : 0);
    }
    const bool is_closed = line.points.front() == line.points.back();
    if (is_dxf_ && is_closed) {
      // The driver gives the polyline of a ring the flag that it is closed, so that its last point
      // need not be the first one again.
      OGRLinearRing ring;
      set_points(ring, line.points.first(line.points.size() - 1));
      feature.SetGeometry(&ring);
    } else {
      OGRLineString open;
      set_points(open, line.points);
      feature.SetGeometry(&open);
    }
    add(feature);
  }

  void add_band(const ContourBand& band) override {
    std::size_t points = 0;
    OGRPolygon polygon;
    for (const std::span<const Point<2>> points_of_ring : band.rings) {
      points += points_of_ring.size() + 1;
      OGRLinearRing ring;
      ring.setNumPoints(static_cast<int>(points_of_ring.size()), FALSE);
      for (std::size_t i = 0; i < points_of_ring.size(); ++i) {
        set_point(ring, i, {points_of_ring[i][0], points_of_ring[i][1], 0});
      }
      ring.set3D(FALSE);
      ring.closeRings();
      polygon.addRing(&ring);
    }
    take_space(points, band.rings.size());
    OGRFeature feature(layer_->GetLayerDefn());
    feature.SetField(kLeast, band.least);
    feature.SetField(kGreatest, band.greatest);
    feature.SetGeometry(&polygon);
    add(feature);
  }

  void finish() override {
    forget_gdal_errors();
    if (in_transaction_ && file_->CommitTransaction() != OGRERR_NONE) fail(gdal_reason());
    if (is_dxf_) check_room_for_dxf();
    file_.reset();  // closing writes what is left: only now can the disk be full
    if (gdal_failed()) fail(gdal_reason());
    if (is_text() && !ends_with(path_, is_json_ ? "}" : "EOF")) {
      fail("its end is missing; is the disk full?");
    }
  }

 private:
  /// Where the driver of DXF keeps what it copies into the file as it closes that.
  [[nodiscard]] std::string dxf_entities() const { return path_ + ".tmp"; }

  /// Where the copy does not fit, the driver looks for the end of a line in bytes that it could not
  /// read, and beyond them: it may end by a signal. Throws Failure before that.
  void check_room_for_dxf() const {
    constexpr std::uint64_t kBeside = std::uint64_t{32} << 10;  // header, trailer, and buffers
    std::error_code unknown;
    const std::uintmax_t entities = std::filesystem::file_size(dxf_entities(), unknown);
    const std::uint64_t needed = (unknown ? 0 : entities) + kBeside;
    if (needed > free_bytes(std::filesystem::path(path_).parent_path())) {
      fail("the disk is full", ENOSPC);
    }
    if (needed > largest_file()) fail("the limit of a file's size is too small (ulimit -f)", EFBIG);
  }

  /// Of a file that is given up: what is copied is nothing, and its room is free. The driver still
  /// writes what it has in its buffer, to the file that has lost its name.
  void drop_dxf_entities() const noexcept {
    const std::string entities = dxf_entities();
    const bool is_there = ::truncate(entities.c_str(), 0) == 0 && ::unlink(entities.c_str()) == 0;
    if (is_there) std::ofstream{entities};
  }

  void create_layer(const VectorLayerOptions& options) {
    OGRSpatialReference crs;
    std::vector<const char*> how = {nullptr};
    bool has_crs = !options.crs.empty();
    if (has_crs) crs = parse_crs(options.crs);
    if (is_json_) {
      // The driver brings coordinates to longitude and latitude, and leaves heights as they are if
      // their system is not known to it.
      crs = horizontal_part(crs);
      is_lonlat_ = !options.as_they_are && crs.IsGeographic() != 0;
      has_crs = has_crs && !options.as_they_are;
      how.insert(how.begin(), options.as_they_are ? "COORDINATE_PRECISION=7" : "RFC7946=YES");
    }
    if (options.driver == "GPKG" && !has_crs) {
      // By this name the driver knows what has the number -1. Without a system it would write 0,
      // which says that coordinates are longitude and latitude (OGC 12-128r18, table 3).
      crs.SetLocalCS("Undefined Cartesian SRS");
      has_crs = true;
    }
    layer_ = file_->CreateLayer(options.layer.c_str(), has_crs ? &crs : nullptr,
                                geometry_of(options.content), const_cast<char**>(how.data()));
    if (layer_ == nullptr) fail(gdal_reason());
    if (options.content == VectorContent::kLines && !is_dxf_) {
      create_field(kElevation, OFTReal);
      create_field(kIndex, OFTInteger);
    } else if (options.content == VectorContent::kBands) {
      create_field(kLeast, OFTReal);
      create_field(kGreatest, OFTReal);
    }
    for (const auto& [name, text] : options.metadata) {
      layer_->SetMetadataItem(name.c_str(), text.c_str());
    }
  }

  void create_field(const char* name, OGRFieldType type) {
    OGRFieldDefn field(name, type);
    if (std::string_view(name) == kIndex) field.SetWidth(1);
    if (layer_->CreateField(&field) != OGRERR_NONE) fail(gdal_reason());
  }

  /// Whether the driver writes text, of which it does not notice that it cannot.
  [[nodiscard]] bool is_text() const { return is_json_ || is_dxf_; }

  void set_points(OGRLineString& line, std::span<const WorldPoint> points) const {
    line.setNumPoints(static_cast<int>(points.size()), FALSE);
    for (std::size_t i = 0; i < points.size(); ++i) set_point(line, i, points[i]);
  }

  void set_point(OGRLineString& line, std::size_t i, const WorldPoint& point) const {
    if (is_lonlat_) check_lonlat(point);
    const double x = is_rounded_ ? rounded(point[0]) : point[0];
    const double y = is_rounded_ ? rounded(point[1]) : point[1];
    line.setPoint(static_cast<int>(i), x, y, point[2]);
  }

  /// Counts a feature of `points` points in `rings` parts, which must fit the format.
  void take_space(std::size_t points, std::size_t rings = 1) {
    shapefile_bytes_ += kShapefileRecord + kShapefilePart * (rings - 1) + kShapefilePoint * points;
    if (is_shapefile_ && shapefile_bytes_ > kShapefileLimit) {
      throw CannotWrite(
          name_,
          fmt::format("a shapefile holds 2 GB, which are full after {} features; choose gpkg",
                      features_),
          ErrorCode::kTooLarge, at_record(features_));
    }
  }

  void add(OGRFeature& feature) {
    forget_gdal_errors();
    if (layer_->CreateFeature(&feature) != OGRERR_NONE || (is_dxf_ && gdal_failed())) {
      // GDAL's driver for GeoJSON refuses nothing but places.
      if (is_json_) fail_for_place(gdal_reason());
      if (disk_is_full(path_)) fail("the disk is full", ENOSPC);
      fail(gdal_reason());
    }
    ++features_;
    if (is_text() && features_ % kFeaturesPerLook == 0 && disk_is_full(path_)) {
      fail("the disk is full", ENOSPC);
    }
    if (in_transaction_ && features_ % kFeaturesPerTransaction == 0 &&
        (file_->CommitTransaction() != OGRERR_NONE || file_->StartTransaction() != OGRERR_NONE)) {
      fail(gdal_reason());
    }
  }

  /// What the driver does not transform, it does not look at either.
  void check_lonlat(const WorldPoint& point) const {
    if (std::abs(point[0]) <= 180 && std::abs(point[1]) <= 90) return;
    fail_for_place(fmt::format("{:.15g}, {:.15g}", point[0], point[1]));
  }

  [[noreturn]] void fail_for_place(const std::string& reason) const {
    throw CannotWrite(name_,
                      fmt::format("coordinates do not become longitude and latitude ({}), as if "
                                  "their coordinate system were another one",
                                  reason),
                      ErrorCode::kBadInput, at_record(features_), Remedy::kWrongCrs);
  }

  /// Because of the system, as far as GDAL tells: it gives a text and no number.
  [[noreturn]] void fail(const std::string& what, int system_error = 0) const {
    throw SystemRefusal(fmt::format("cannot write {}: {}", name_, what), name_, system_error);
  }

  std::string name_;
  std::string path_;
  bool is_shapefile_;
  bool is_json_;
  bool is_dxf_;
  bool is_rounded_;         ///< coordinates have no unit that tells how many digits make sense
  bool is_lonlat_ = false;  ///< coordinates have to be longitude and latitude as they come
  std::unique_ptr<DxfTemplate> dxf_template_;  ///< the driver reads it when it closes the file
  GDALDatasetUniquePtr file_;
  OGRLayer* layer_ = nullptr;  // owned by file_
  bool in_transaction_ = false;
  std::uint64_t features_ = 0;
  std::uint64_t shapefile_bytes_ = kShapefileHeader;
};

}  // namespace

std::unique_ptr<VectorLayer> create_ogr_layer(const VectorLayerOptions& options) {
  return std::make_unique<OgrLayer>(options);
}

}  // namespace spillway::formats
