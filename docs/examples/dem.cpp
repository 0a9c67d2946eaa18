// Points to a GeoTIFF of heights and slopes. Needs a Spillway that was built with GDAL.
#include <spillway/dem.h>
#include <spillway/triangulate.h>

#include <cstdio>
#include <vector>

int main() {
  std::vector<spillway::Point<3>> slope;
  for (int x = 0; x <= 100; ++x) {
    for (int y = 0; y <= 50; ++y) slope.push_back({double(x), double(y), 0.5 * x});
  }
  try {
    const spillway::Context context({.memory = "128M"});
    spillway::DemOptions options;
    options.resolution = 0.5;
    options.products = {spillway::DemProduct::kHeight, spillway::DemProduct::kSlope};
    const auto dem = spillway::create_dem("slope.tif", options, context);
    spillway::triangulate(*spillway::points_in_memory(slope), *dem, {}, context);

    const spillway::DemReport& report = dem->report();
    std::printf("%u x %u pixels\n", report.columns, report.rows);
    for (const std::string& band : report.bands) std::printf("band %s\n", band.c_str());
  } catch (const spillway::Error& error) {
    std::fprintf(stderr, "%s: %s\n", to_string(error.code()), error.what());
    return 1;
  }
}
