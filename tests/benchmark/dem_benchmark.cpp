// `spillway dem` of a LAS file beside `gdal_grid -a linear` of the same points and the same pixels,
// and beside `spillway triangulate` of the same file. Prints a Markdown table; medians over turns.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/delaunay/common/schedule.h"

namespace spillway::test {
namespace {

struct Plan {
  std::string command = SPILLWAY_COMMAND;
  std::string folder = ".";
  std::vector<std::uint64_t> points{1'000'000};
  double resolution = 0.5;
  std::string memory = "512M";
  unsigned threads = 2;
  unsigned turns = 3;
  std::uint64_t most_for_gdal = 1'000'000;  // gdal_grid holds all of them in memory
};

/// Seconds of a shell command; ends the program if it fails.
double time_of(const std::string& command) {
  double seconds = 0;
  int status = 0;
  {
    const Stopwatch watch(seconds);
    status = std::system(command.c_str());
  }
  if (status != 0) {
    fmt::print(stderr, "{} failed\n", command);
    std::exit(1);
  }
  return seconds;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// The points as a layer that gdal_grid reads.
void write_table(const Plan& plan) {
  time_of(
      fmt::format("cd {} && {} convert -q dem.las -o dem.xyz && "
                  "{{ echo x,y,z; grep -v '[a-z#]' dem.xyz | tr ' ' ','; }} > table.csv",
                  plan.folder, plan.command));
  std::ofstream(plan.folder + "/table.vrt")
      << "<OGRVRTDataSource><OGRVRTLayer name='table'><SrcDataSource relativeToVRT='1'>table.csv"
         "</SrcDataSource><GeometryType>wkbPoint</GeometryType><GeometryField "
         "encoding='PointFromColumns' x='x' y='y' z='z'/></OGRVRTLayer></OGRVRTDataSource>";
}

void compare(const Plan& plan, std::uint64_t count) {
  const std::string& folder = plan.folder;
  const std::string common = fmt::format("-q --memory {} --threads {} --scratch-folder {}",
                                         plan.memory, plan.threads, folder);
  time_of(fmt::format("{} generate -q terrain -n {} -o {}/dem.las", plan.command, count, folder));
  const bool with_gdal = count <= plan.most_for_gdal;
  if (with_gdal) write_table(plan);
  std::vector<double> triangulate;
  std::vector<double> dem;
  std::vector<double> grid;
  nlohmann::json raster;
  for (unsigned turn = 0; turn < plan.turns; ++turn) {
    triangulate.push_back(time_of(fmt::format("{} triangulate {} {}/dem.las -o {}/dem.spm",
                                              plan.command, common, folder, folder)));
    dem.push_back(time_of(
        fmt::format("{} dem {} {}/dem.las -o {}/dem.tif --resolution {} --stats {}/dem.json",
                    plan.command, common, folder, folder, plan.resolution, folder)));
    raster = nlohmann::json::parse(std::ifstream(folder + "/dem.json"))["raster"];
    if (!with_gdal) continue;
    const auto west = raster["west"].get<double>();
    const auto north = raster["north"].get<double>();
    const auto columns = raster["columns"].get<double>();
    const auto rows = raster["rows"].get<double>();
    grid.push_back(time_of(fmt::format(
        "gdal_grid -q -a linear:radius=0:nodata=-9999 -txe {} {} -tye {} {} -outsize {} {} -ot "
        "Float32 -co TILED=YES -co COMPRESS=DEFLATE -co PREDICTOR=3 -l table {}/table.vrt "
        "{}/grid.tif",
        west, west + columns * plan.resolution, north, north - rows * plan.resolution, columns,
        rows, folder, folder)));
  }
  const auto n = static_cast<double>(count);
  fmt::print("| {} | {} x {} | {:.2f} | {:.2f} | **{:.2f}** | {} | {} |\n", count,
             raster["columns"].get<int>(), raster["rows"].get<int>(), 1e6 * median(triangulate) / n,
             1e6 * median(dem) / n, median(dem) / median(triangulate),
             with_gdal ? fmt::format("{:.2f}", 1e6 * median(grid) / n) : "-",
             with_gdal ? fmt::format("{:.1f}", median(grid) / median(dem)) : "-");
  std::fflush(stdout);
  for (const char* file : {"dem.las", "dem.xyz", "dem.spm", "dem.tif", "dem.json", "grid.tif",
                           "table.csv", "table.vrt"}) {
    std::filesystem::remove(std::filesystem::path(folder) / file);
  }
}

}  // namespace
}  // namespace spillway::test

int main(int argc, char** argv) {
  spillway::test::Plan plan;
  CLI::App app("Times `spillway dem` beside `gdal_grid -a linear`");
  app.add_option("--command", plan.command, "The spillway to run");
  app.add_option("--folder", plan.folder, "Where all files lie");
  app.add_option("-n,--points", plan.points, "Points of each run")->delimiter(',');
  app.add_option("--resolution", plan.resolution, "Side of a pixel in metres");
  app.add_option("-m,--memory", plan.memory, "--memory of each run");
  app.add_option("--threads", plan.threads, "Threads");
  app.add_option("-r,--turns", plan.turns, "Turns");
  app.add_option("--most-for-gdal", plan.most_for_gdal, "Leave gdal_grid out above so many points");
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "| points | pixels | triangulate us/pt | dem us/pt | dem / triangulate | gdal_grid us/pt | "
      "gdal_grid / dem |\n|---|---|---|---|---|---|---|\n");
  for (const std::uint64_t count : plan.points) spillway::test::compare(plan, count);
}
