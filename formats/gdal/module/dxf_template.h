#pragma once
// What a DXF file begins with, within the module.

#include <string>

#include "src/rooms.h"

namespace spillway::formats {

/// GDAL's own template of the sections before a DXF file's entities, but with the unit of the
/// drawing: GDAL's says inches. It is a file in memory while this object lives.
class DxfTemplate {
 public:
  /// For the file `name` with coordinates in `crs` (may be empty: no unit). Throws Failure if GDAL
  /// is installed without its template.
  DxfTemplate(const std::string& name, const std::string& crs);
  ~DxfTemplate();
  DxfTemplate(const DxfTemplate&) = delete;
  DxfTemplate& operator=(const DxfTemplate&) = delete;

  /// Its name for GDAL.
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::string text_;
};

}  // namespace spillway::formats
