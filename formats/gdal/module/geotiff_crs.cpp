#include "formats/gdal/module/geotiff_crs.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "formats/gdal/module/crs.h"
#include "formats/gdal/module/gdal_errors.h"

namespace spillway::formats {
namespace {

/// Types of TIFF's values (TIFF 6.0, p. 15), and the bytes of each.
enum class TiffType : std::uint16_t { kText = 2, kShort = 3, kLong = 4, kDouble = 12 };

std::size_t size_of(TiffType type) {
  switch (type) {
    case TiffType::kText:
      return 1;
    case TiffType::kShort:
      return 2;
    case TiffType::kLong:
      return 4;
    case TiffType::kDouble:
      return 8;
  }
  return 0;
}

/// The smallest file that GDAL takes for a GeoTIFF: one pixel, and keys (TIFF 6.0, p. 13 to 22).
class TinyTiff {
 public:
  /// Tags come in ascending order.
  void add(std::uint16_t tag, TiffType type, std::span<const std::byte> values) {
    tags_.push_back({tag, type, {values.begin(), values.end()}});
  }
  void add(std::uint16_t tag, TiffType type, std::uint32_t value) {
    add(tag, type, std::as_bytes(std::span(&value, 1)).first(size_of(type)));
  }

  [[nodiscard]] std::vector<std::byte> bytes() const {
    std::vector<std::byte> file;
    std::vector<std::byte> rest;  // values that do not fit into their entries
    put(file, std::array<std::uint16_t, 2>{0x4949, 42});
    put(file, std::uint32_t{8});
    put(file, static_cast<std::uint16_t>(tags_.size()));
    constexpr std::size_t kEntry = 12;
    const std::size_t end = 8 + 2 + kEntry * tags_.size() + 4;
    for (const Tag& tag : tags_) {
      put(file, std::array{tag.number, static_cast<std::uint16_t>(tag.type)});
      put(file, static_cast<std::uint32_t>(tag.values.size() / size_of(tag.type)));
      std::array<std::byte, 4> field{};
      if (tag.values.size() <= field.size()) {
        std::copy(tag.values.begin(), tag.values.end(), field.begin());
      } else {
        const auto place = static_cast<std::uint32_t>(end + rest.size());
        std::memcpy(field.data(), &place, sizeof(place));
        rest.insert(rest.end(), tag.values.begin(), tag.values.end());
        rest.resize((rest.size() + 7) / 8 * 8);
      }
      put(file, field);
    }
    put(file, std::uint32_t{0});
    file.insert(file.end(), rest.begin(), rest.end());
    return file;
  }

 private:
  struct Tag {
    std::uint16_t number;
    TiffType type;
    std::vector<std::byte> values;
  };

  template <typename T>
  static void put(std::vector<std::byte>& bytes, const T& value) {
    bytes.resize(bytes.size() + sizeof(value));
    std::memcpy(&bytes[bytes.size() - sizeof(value)], &value, sizeof(value));
  }

  std::vector<Tag> tags_;
};

std::vector<std::byte> tiff_of(const GeotiffKeys& keys) {
  TinyTiff tiff;
  tiff.add(256, TiffType::kShort, 1);  // columns
  tiff.add(257, TiffType::kShort, 1);  // rows
  tiff.add(258, TiffType::kShort, 8);  // bits of a pixel
  tiff.add(259, TiffType::kShort, 1);  // no compression
  tiff.add(262, TiffType::kShort, 1);  // black is 0
  tiff.add(273, TiffType::kLong, 8);   // where pixels lie: anywhere, as none is read
  tiff.add(277, TiffType::kShort, 1);  // bands
  tiff.add(278, TiffType::kShort, 1);  // rows of a strip
  tiff.add(279, TiffType::kLong, 1);   // bytes of it
  const std::span<const std::byte> directory = keys.directory;
  tiff.add(34735, TiffType::kShort, directory.first(directory.size() / 2 * 2));
  const std::span<const std::byte> numbers = keys.numbers;
  if (numbers.size() >= 8) {
    tiff.add(34736, TiffType::kDouble, numbers.first(numbers.size() / 8 * 8));
  }
  std::string text = keys.text;
  text += '\0';
  tiff.add(34737, TiffType::kText, std::as_bytes(std::span(text)));
  return tiff.bytes();
}

/// A file in memory that GDAL finds under its name.
class MemoryFile {
 public:
  explicit MemoryFile(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {
    static std::atomic<std::uint64_t> count = 0;
    name_ = fmt::format("/vsimem/spillway_keys_{}.tif", count++);
    VSIFCloseL(VSIFileFromMemBuffer(name_.c_str(), reinterpret_cast<GByte*>(bytes_.data()),
                                    bytes_.size(), FALSE));
  }
  ~MemoryFile() { VSIUnlink(name_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::vector<std::byte> bytes_;
  std::string name_;
};

/// Else heights are read of version 1.1 of GeoTIFF only, which few files say that they are of.
class ReportHeights {
 public:
  ReportHeights() { CPLSetThreadLocalConfigOption(kOption, "YES"); }
  ~ReportHeights() { CPLSetThreadLocalConfigOption(kOption, nullptr); }
  ReportHeights(const ReportHeights&) = delete;
  ReportHeights& operator=(const ReportHeights&) = delete;

 private:
  static constexpr const char* kOption = "GTIFF_REPORT_COMPD_CS";
};

bool is_of_kind(const OGRSpatialReference& crs, CrsKind kind) {
  switch (kind) {
    case CrsKind::kProjected:
      return crs.IsProjected() != 0;
    case CrsKind::kGeographic:
      return crs.IsGeographic() != 0;
    default:
      return false;
  }
}

std::string read(const GeotiffKeys& keys, CrsKind kind) {
  forget_gdal_errors();
  const MemoryFile tiff(tiff_of(keys));
  const ReportHeights heights;
  const std::array<const char*, 2> drivers = {"GTiff", nullptr};
  const GDALDatasetUniquePtr file(
      GDALDataset::Open(tiff.name().c_str(), GDAL_OF_RASTER, drivers.data(), nullptr, nullptr));
  const OGRSpatialReference* const crs = file ? file->GetSpatialRef() : nullptr;
  if (crs == nullptr || gdal_failed() || !is_of_kind(*crs, kind)) return "";
  return wkt_of(crs);
}

}  // namespace

std::string crs_of_geotiff_keys(const GeotiffKeys& keys, CrsKind kind) {
  // The files of a survey have the same keys, and reading these takes most of a millisecond.
  struct Last {
    GeotiffKeys keys;
    CrsKind kind = CrsKind::kUnknown;
    std::string crs;
  };
  thread_local Last last;
  if (last.kind != kind || last.keys != keys) last = {keys, kind, read(keys, kind)};
  return last.crs;
}

}  // namespace spillway::formats
