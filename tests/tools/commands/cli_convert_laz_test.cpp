// LAZ from the command, read back by the decoder of somebody else, record by record.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

/// Compares each record that laz-perf decodes of a LAZ file with that of a LAS file.
constexpr const char* kDecode = R"(
const fs = require('fs');
const { createLazPerf } = require('laz-perf');
(async () => {
  const [laz, las] = process.argv.slice(2).map((name) => fs.readFileSync(name));
  const first = las.readUInt32LE(96);
  const length = las.readUInt16LE(105);
  const count = las.readUInt8(25) < 4 ? las.readUInt32LE(107) : Number(las.readBigUInt64LE(247));
  const perf = await createLazPerf();
  const file = perf._malloc(laz.length);
  const record = perf._malloc(length);
  perf.HEAPU8.set(laz, file);
  const reader = new perf.LASZip();
  reader.open(file, laz.length);
  if (reader.getCount() !== count) throw new Failure(`${reader.getCount()} of ${count} points`);
  for (let i = 0; i < count; ++i) {
    reader.getPoint(record);
    const decoded = Buffer.from(perf.HEAPU8.subarray(record, record + length));
    const stored = las.subarray(first + i * length, first + (i + 1) * length);
    if (!decoded.equals(stored)) {
      throw new Failure(`record ${i}: ${decoded.toString('hex')}, not ${stored.toString('hex')}`);
    }
  }
  console.log(`format ${las.readUInt8(104)}, ${count} points`);
})().catch((error) => { console.error(error.message); process.exit(1); });
)";

/// A table from which LAS of that point format is made, with extra bytes.
std::string table_of(int point_format, int points) {
  const bool has_time = point_format != 0;
  const bool has_colour = point_format == 3 || point_format >= 7;
  std::string text = "x,y,z,intensity,return_number,number_of_returns,class,user_data,amplitude";
  if (has_time) text += ",gps_time";
  if (has_colour) text += ",red,green,blue";
  if (point_format == 8) text += ",nir";
  text += '\n';
  std::mt19937 random(static_cast<unsigned>(point_format));
  for (int i = 0; i < points; ++i) {
    text += fmt::format("{},{},{},{},{},{},{},{},{}", static_cast<double>(random() % 100'000) / 100,
                        static_cast<double>(i) / 100, static_cast<double>(random() % 1000) / 100,
                        random() % 65'536, 1 + random() % 5, 1 + random() % 5, random() % 32,
                        random() % 256, static_cast<double>(random() % 1000) / 8);
    if (has_time) text += fmt::format(",{}", static_cast<double>(random()) / 1024);
    for (int c = 0; has_colour && c < 3; ++c) text += fmt::format(",{}", random() % 65'536);
    if (point_format == 8) text += fmt::format(",{}", random() % 65'536);
    text += '\n';
  }
  return text;
}

/// By point format.
class ConvertLaz : public ::testing::TestWithParam<int> {};

TEST_P(ConvertLaz, IsDecodedByTheNpmPackageLazPerfToTheRecordsOfLas) {
  const Workspace work;
  if (work.run("node -e \"require('laz-perf')\"").exit_code != 0) {
    GTEST_SKIP() << "node, or its package laz-perf, is not there: npm install laz-perf, and "
                    "NODE_PATH";
  }
  const int points = GetParam() == 3 || GetParam() == 7 ? 60'000 : 3000;  // of several chunks
  work.write("decode.cjs", kDecode);
  work.write("in.csv", table_of(GetParam(), points));
  const std::string out = work.succeed(
      fmt::format("spillway convert -q in.csv -o in.las --scale 0.01 --las-version {}\n"
                  "spillway convert -q in.las -o in.laz\n"
                  "node decode.cjs in.laz in.las",
                  GetParam() < 6 ? "1.2" : "1.4"));
  EXPECT_EQ(out, fmt::format("format {}, {} points\n", GetParam(), points));
}

INSTANTIATE_TEST_SUITE_P(PointFormats, ConvertLaz, ::testing::Values(0, 1, 3, 6, 7, 8));

}  // namespace
}  // namespace spillway::test
