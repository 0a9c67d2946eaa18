#include "formats/gdal/module/dxf_template.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <string_view>

#include "formats/gdal/module/crs.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// The variable of the header that says in what unit the drawing is: a group code and a number, a
/// line each.
constexpr std::string_view kUnits = "$INSUNITS\n";

/// A drawing's unit by its number (Autodesk, "DXF Reference", AC1018: $INSUNITS), for a unit of so
/// many metres.
int drawing_unit(double metres) {
  struct Unit {
    int number;
    double metres;
  };
  constexpr Unit kKnown[] = {{2, 0.3048}, {6, 1}, {7, 1000}, {21, 1200.0 / 3937.0}};
  constexpr double kTold = 1e-9;  // in what coordinate systems say of their units
  for (const Unit& unit : kKnown) {
    if (std::abs(metres - unit.metres) < kTold) return unit.number;
  }
  return 0;
}

}  // namespace

DxfTemplate::DxfTemplate(const std::string& name, const std::string& crs) {
  const char* const file = CPLFindFile("gdal", "header.dxf");
  std::ifstream in(file == nullptr ? "" : file, std::ios::binary);
  text_.assign(std::istreambuf_iterator<char>(in), {});
  const std::size_t units = text_.find(kUnits);
  if (units == std::string::npos) {
    throw Failure(
        fmt::format("cannot write {}: GDAL is installed without its template header.dxf; "
                    "install its data (gdal-data), or name its folder by GDAL_DATA",
                    name));
  }
  const std::size_t code = units + kUnits.size();
  const std::size_t number = text_.find('\n', code) + 1;
  const std::size_t end = text_.find('\n', number);
  text_.replace(number, end - number,
                fmt::format("{:6}", crs.empty() ? 0 : drawing_unit(crs_unit(crs))));
  path_ = fmt::format("/vsimem/spillway-{}.dxf", static_cast<const void*>(this));
  VSILFILE* const copy =
      VSIFileFromMemBuffer(path_.c_str(), reinterpret_cast<GByte*>(text_.data()), text_.size(), 0);
  if (copy != nullptr) VSIFCloseL(copy);
}

DxfTemplate::~DxfTemplate() { VSIUnlink(path_.c_str()); }

}  // namespace spillway::formats
