// Points come out by pixel and height as if memory had no limit, in whatever order and by however
// many threads they came.

#include "stream/sinks/pixel_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>

#include "formats/disk/file_system.h"
#include "formats/disk/kept_scratch.h"
#include "formats/disk/private_file.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "tests/formats/inputs/temporary_files.h"

namespace spillway::test {
namespace {

std::vector<PointInPixel> random_points(std::size_t count, std::uint64_t tiles, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<PointInPixel> points(count);
  for (PointInPixel& point : points) {
    // Many in few pixels, and a tile without any.
    std::uint64_t tile = random() % tiles;
    if (tile == 1) tile = 0;
    const std::uint64_t pixel = random() % 4 == 0 ? 77 : random() % PixelPoints::kTilePixels;
    point = {tile * PixelPoints::kTilePixels + pixel,
             static_cast<double>(random() % 1000) - (random() % 3 == 0 ? 0.25 : 500)};
  }
  return points;
}

std::vector<PointInPixel> read_tile(PixelPoints& store, std::uint64_t tile) {
  std::vector<PointInPixel> points;
  store.read(tile, [&](const PointInPixel& point) { points.push_back(point); });
  return points;
}

std::vector<PointInPixel> of_tile(const std::vector<PointInPixel>& sorted, std::uint64_t tile) {
  std::vector<PointInPixel> points;
  std::ranges::copy_if(sorted, std::back_inserter(points), [&](const PointInPixel& point) {
    return point.pixel / PixelPoints::kTilePixels == tile;
  });
  return points;
}

std::unique_ptr<ScratchFolder> scratch() {
  return make_scratch_folder(::testing::TempDir(), std::nullopt);
}

TEST(PixelPoints, ComeSortedWhateverTheMemoryAndTheThreads) {
  constexpr std::uint64_t kTiles = 7;
  std::vector<PointInPixel> sorted = random_points(300'000, kTiles, 1);
  const std::vector<PointInPixel> points = sorted;
  std::ranges::sort(sorted);
  // From all in memory to hundreds of runs, which are merged on the way.
  for (const std::uint64_t memory :
       {std::uint64_t{1} << 30, std::uint64_t{1} << 20, std::uint64_t{20'000}}) {
    for (const unsigned threads : {1U, 3U}) {
      const auto folder = scratch();
      PixelPoints store(memory, *folder);
      std::vector<std::thread> adding;
      for (unsigned t = 0; t < threads; ++t) {
        adding.emplace_back([&, t] {
          const std::size_t begin = points.size() * t / threads;
          const std::size_t end = points.size() * (t + 1) / threads;
          for (std::size_t i = begin; i < end; i += 1000) {
            store.add(std::span(points).subspan(i, std::min<std::size_t>(1000, end - i)));
          }
        });
      }
      for (std::thread& one : adding) one.join();
      EXPECT_EQ(store.spilled_bytes() > 0, memory <= 1 << 20);
      for (std::uint64_t tile = 0; tile < kTiles; ++tile) {
        EXPECT_TRUE(read_tile(store, tile) == of_tile(sorted, tile)) << tile;
      }
      // Not in their order, and once more.
      for (const std::uint64_t tile : {5U, 0U, 1U, 6U, 3U, 3U}) {
        EXPECT_TRUE(read_tile(store, tile) == of_tile(sorted, tile)) << tile;
      }
    }
  }
}

TEST(PixelPoints, APixelMayHaveMorePointsThanMemoryHolds) {
  const auto folder = scratch();
  PixelPoints store(50'000, *folder);
  constexpr int kCount = 100'000;
  for (int i = 0; i < kCount; ++i) {
    const PointInPixel point{5, static_cast<double>(i * 7919 % kCount)};
    store.add({&point, 1});
  }
  double next = 0;
  store.read(0, [&](const PointInPixel& point) { EXPECT_EQ(point.z, next++); });
  EXPECT_EQ(next, kCount);
}

TEST(PixelPoints, AnotherProcessGoesOn) {
  const TemporaryFiles files;
  std::vector<PointInPixel> sorted = random_points(40'000, 3, 9);
  const std::vector<PointInPixel> points = sorted;
  std::ranges::sort(sorted);
  const std::span<const PointInPixel> all(points);
  const std::string file = files.path("state");
  std::uint64_t made = 0;
  {
    KeptScratchFolder scratch(files.path("scratch"), std::nullopt);
    PixelPoints killed(100'000, scratch);
    killed.add(all.first(25'000));
    StateWriter writer(create_private_file(file, file));
    killed.save(writer);
    writer.finish();
    made = scratch.files_made();
    killed.add(all.subspan(25'000));  // which merges runs that were saved
  }
  KeptScratchFolder scratch(files.path("scratch"), std::nullopt);
  StateReader reader(disk().open(file), file);
  reader.use_scratch(scratch);
  scratch.go_on_after(made);
  PixelPoints store(100'000, scratch);
  store.restore(reader);
  reader.finish();
  store.add(all.subspan(25'000));
  for (std::uint64_t tile = 0; tile < 3; ++tile) {
    EXPECT_TRUE(read_tile(store, tile) == of_tile(sorted, tile)) << tile;
  }
}

}  // namespace
}  // namespace spillway::test
