#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/points/las/las_header.h"
#include "formats/points/laz/chunk_encoder.h"
#include "formats/points/laz/chunk_table.h"
#include "tests/formats/points/laz/laz_encoder/decoded_records.h"
#include "tests/formats/shared_data.h"

// The chunks of real files, decoded to whole records and encoded again.

namespace spillway::test {
namespace {

class ReencodedLaz : public ::testing::TestWithParam<std::string> {};

TEST_P(ReencodedLaz, HasTheBytesOfTheEncoderThatMadeIt) {
  const std::filesystem::path path = shared_file(GetParam().c_str());
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const std::string bytes = content_of(path);
  InputBytes source(disk().open(path));
  const LasHeader las = read_las_header(source);
  ASSERT_TRUE(las.laz);
  const auto table = read_chunk_table(source, las);
  ASSERT_TRUE(table);
  LazChunkEncoder encoder(las.laz->format);
  for (const LazChunk& place : table->chunks) {
    const std::span<const std::byte> chunk = as_bytes_of(bytes).subspan(place.offset, place.bytes);
    const std::string records = decode_laz_records(las.laz->format, chunk, place.count);
    std::vector<std::byte> again;
    encoder.encode(as_bytes_of(records), again);
    EXPECT_TRUE(std::ranges::equal(chunk, again))
        << place.bytes << " bytes became " << again.size() << " at byte " << place.offset;
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ReencodedLaz,
                         ::testing::Values("autzen_trim.laz", "lone-star.laz", "crop.laz",
                                           "crop_1.laz", "crop_2.laz", "Megaplot.laz",
                                           "MixedConifer.laz", "Topography.laz",
                                           "1.2-with-color.copc.laz", "lone-star.copc.laz",
                                           "las_with_several_extra_byte_bloc.laz"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::ranges::replace_if(
                               name, [](char c) { return c == '.' || c == '-'; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace spillway::test
