// Pixels come out of the store as if memory had no limit, whatever went to the disk meanwhile and
// in whatever order their values came.

#include "stream/sinks/raster_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>
#include <thread>

#include "formats/disk/kept_scratch.h"
#include "formats/disk/private_file.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"
#include "src/error.h"
#include "tests/error_facts.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr std::uint64_t kTileBytes = RasterStore::kTilePixels * sizeof(float);
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
const std::vector<PixelRule> kAllRules = {PixelRule::kEqual, PixelRule::kPreferred,
                                          PixelRule::kSum};

/// A value on its way to a pixel.
struct Put {
  std::uint64_t tile = 0;
  std::size_t pixel = 0;  ///< in all bands
  float value = 0;
  bool preferred = false;
};

void put(RasterStore::Hand& hand, const std::vector<PixelRule>& bands, const Put& one) {
  float* const pixels = hand.tile(one.tile);
  put_pixel(pixels[one.pixel], one.value, bands[one.pixel / RasterStore::kTilePixels],
            one.preferred);
}

/// Values for few pixels, so that many meet; those of kEqual are equal in a pixel.
std::vector<Put> random_puts(std::size_t count, std::uint64_t tiles, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Put> puts(count);
  for (Put& one : puts) {
    one.tile = random() % tiles;
    const std::size_t band = random() % kAllRules.size();
    one.pixel = band * RasterStore::kTilePixels + random() % 50 * 997;
    one.preferred = random() % 8 == 0;
    // One preferred value for a pixel, as a rule that prefers gives.
    one.value = band == 0 || one.preferred ? static_cast<float>(one.pixel % 101)
                                           : static_cast<float>(random() % 1000);
  }
  return puts;
}

void put_all(RasterStore& store, const std::vector<Put>& puts) {
  RasterStore::Hand hand(store);
  for (const Put& one : puts) put(hand, kAllRules, one);
}

/// All tiles, nothing as -1 so that they can be compared.
std::vector<std::vector<float>> take_all(RasterStore& store, std::uint64_t tiles) {
  std::vector<std::vector<float>> all(tiles);
  for (std::uint64_t t = 0; t < tiles; ++t) {
    store.take(t, all[t]);
    for (float& pixel : all[t]) {
      if (std::isnan(pixel)) pixel = -1;
    }
  }
  return all;
}

class RasterStoreTest : public ::testing::Test {
 protected:
  std::unique_ptr<ScratchFolder> scratch_ = make_scratch_folder(::testing::TempDir(), std::nullopt);
};

/// What becomes of one pixel.
float pixel_after(PixelRule rule, const std::vector<std::pair<float, bool>>& values) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  RasterStore store({rule}, 10 * kTileBytes, *scratch);
  {
    RasterStore::Hand hand(store);
    for (const auto& [value, preferred] : values) put_pixel(*hand.tile(0), value, rule, preferred);
  }
  std::vector<float> pixels;
  store.take(0, pixels);
  return pixels[0];
}

TEST(PutPixel, EqualHoldsTheLastOne) {
  EXPECT_EQ(pixel_after(PixelRule::kEqual, {{-7.5F, false}, {-7.5F, true}}), -7.5F);
}

TEST(PutPixel, PreferredHoldsThePreferredOneElseTheSmallest) {
  using Values = std::vector<std::pair<float, bool>>;
  for (Values values : {Values{{5, false}, {3, false}, {9, false}}, Values{{3, false}}}) {
    do {
      EXPECT_EQ(pixel_after(PixelRule::kPreferred, values), 3);
    } while (std::next_permutation(values.begin(), values.end()));
  }
  Values values = {{1, false}, {3, false}, {8, true}};
  do {
    EXPECT_EQ(pixel_after(PixelRule::kPreferred, values), 8);
  } while (std::next_permutation(values.begin(), values.end()));
}

TEST(PutPixel, PreferredTakesMinusZeroForZero) {
  for (const bool preferred : {false, true}) {
    const float pixel = pixel_after(PixelRule::kPreferred, {{-0.0F, preferred}, {2, false}});
    EXPECT_EQ(pixel, 0);
    EXPECT_FALSE(std::signbit(pixel));
  }
}

TEST(PutPixel, SumEndsWhereFloatsNoLongerCountByOne) {
  EXPECT_EQ(pixel_after(PixelRule::kSum, {{1, false}, {2, false}, {4, false}}), 7);
  EXPECT_EQ(pixel_after(PixelRule::kSum, {{0x1p24F, false}, {2, false}}), 0x1p24F);
}

TEST(PutPixel, SumLosesNothingBetweenThreads) {
  float pixel = kNothing;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&pixel] {
        for (int i = 0; i < 20'000; ++i) put_pixel(pixel, 1, PixelRule::kSum, false);
      });
    }
  }
  EXPECT_EQ(pixel, 80'000);
}

TEST_F(RasterStoreTest, GivesNothingForTilesThatNobodyHasWrittenTo) {
  RasterStore store(kAllRules, 0, *scratch_);
  EXPECT_THAT(store.tiles(), IsEmpty());
  std::vector<float> pixels = {1, 2};
  store.take(7, pixels);
  EXPECT_EQ(pixels.size(), kAllRules.size() * RasterStore::kTilePixels);
  EXPECT_TRUE(std::all_of(pixels.begin(), pixels.end(), [](float p) { return std::isnan(p); }));
  EXPECT_EQ(store.spilled_bytes(), 0U);
}

TEST_F(RasterStoreTest, SpillsNothingThatFits) {
  RasterStore store(kAllRules, 30 * kTileBytes, *scratch_);
  put_all(store, random_puts(2000, 10, 1));
  EXPECT_EQ(store.spilled_bytes(), 0U);
}

TEST_F(RasterStoreTest, GivesTheSamePixelsHoweverLittleMemoryItHas) {
  constexpr std::uint64_t kTiles = 25;
  const std::vector<Put> puts = random_puts(3000, kTiles, 2);
  RasterStore large(kAllRules, std::uint64_t{1} << 30, *scratch_);
  put_all(large, puts);
  const auto expected = take_all(large, kTiles);
  EXPECT_EQ(large.spilled_bytes(), 0U);
  for (const std::uint64_t tiles : {0, 1, 12}) {
    RasterStore small(kAllRules, tiles * kAllRules.size() * kTileBytes, *scratch_);
    put_all(small, puts);
    EXPECT_GT(small.spilled_bytes(), 0U) << tiles;
    EXPECT_TRUE(take_all(small, kTiles) == expected) << tiles;
    EXPECT_THAT(small.tiles(), IsEmpty()) << "taken tiles are forgotten";
  }
}

TEST_F(RasterStoreTest, GivesTheSamePixelsToManyThreads) {
  constexpr std::uint64_t kTiles = 12;
  const std::vector<Put> puts = random_puts(4000, kTiles, 3);
  RasterStore one(kAllRules, std::uint64_t{1} << 30, *scratch_);
  put_all(one, puts);
  RasterStore shared(kAllRules, 9 * kAllRules.size() * kTileBytes, *scratch_);
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 4; ++t) {
      threads.emplace_back([&, t] {
        RasterStore::Hand hand(shared);
        for (std::size_t i = t; i < puts.size(); i += 4) put(hand, kAllRules, puts[i]);
      });
    }
  }
  EXPECT_TRUE(take_all(shared, kTiles) == take_all(one, kTiles));
}

TEST_F(RasterStoreTest, KeepsTheTilesInAHandWhereTheyAre) {
  RasterStore store({PixelRule::kEqual}, 0, *scratch_);
  RasterStore::Hand hand(store);
  RasterStore::Hand other(store);
  std::set<float*> tiles;
  for (std::uint64_t t = 0; t < RasterStore::kTilesInHand; ++t) tiles.insert(hand.tile(t));
  EXPECT_EQ(tiles.size(), RasterStore::kTilesInHand);
  for (std::uint64_t t = 100; t < 150; ++t) set_pixel(*other.tile(t), 1);
  for (std::uint64_t t = 0; t < RasterStore::kTilesInHand; ++t) {
    EXPECT_TRUE(tiles.contains(hand.tile(t)));
    EXPECT_EQ(other.tile(t), hand.tile(t)) << "two hands hold one tile";
  }
}

/// Puts a value into each pixel of a band, and says that all are decided.
void fill_tile(RasterStore::Hand& hand, std::uint64_t number, bool decides = true) {
  float* const pixels = hand.tile(number);
  ASSERT_NE(pixels, nullptr) << number;
  for (std::size_t p = 0; p < RasterStore::kTilePixels; ++p) {
    set_pixel(pixels[p], static_cast<float>(number) * 1000 - static_cast<float>(p % 97));
  }
  if (decides) hand.decide(RasterStore::kTilePixels);
}

std::uint32_t all_pixels(std::uint64_t /*tile*/) { return RasterStore::kTilePixels; }

TEST_F(RasterStoreTest, TakesNothingMoreForATileThatIsClosed) {
  RasterStore store({PixelRule::kEqual}, 30 * kTileBytes, *scratch_, all_pixels);
  RasterStore::Hand hand(store);
  RasterStore::Hand other(store);
  other.tile(5);
  fill_tile(hand, 5);
  hand.release();
  EXPECT_NE(hand.tile(5), nullptr) << "another hand holds it";
  hand.release();
  EXPECT_EQ(store.closed_tiles(), 0U);
  other.release();
  EXPECT_EQ(store.closed_tiles(), 1U);
  EXPECT_EQ(hand.tile(5), nullptr);
  EXPECT_NE(hand.tile(6), nullptr);
}

TEST_F(RasterStoreTest, LeavesATileOpenWhosePixelsAreNotAllDecided) {
  RasterStore store({PixelRule::kEqual}, 30 * kTileBytes, *scratch_, all_pixels);
  RasterStore::Hand hand(store);
  set_pixel(*hand.tile(5), 1);
  hand.decide(RasterStore::kTilePixels - 1);
  hand.release();
  ASSERT_NE(hand.tile(5), nullptr);
  hand.decide(1);
  hand.release();
  EXPECT_EQ(hand.tile(5), nullptr);
}

TEST_F(RasterStoreTest, GivesTheSamePixelsOfClosedTilesHoweverLittleMemoryItHas) {
  constexpr std::uint64_t kTiles = 40;
  RasterStore large({PixelRule::kEqual}, std::uint64_t{1} << 30, *scratch_);
  {
    RasterStore::Hand hand(large);
    for (std::uint64_t t = 0; t < kTiles; ++t) fill_tile(hand, t, false);
  }
  const auto expected = take_all(large, kTiles);
  for (const std::uint64_t tiles : {0, 9, 20}) {
    RasterStore small({PixelRule::kEqual}, tiles * kTileBytes, *scratch_, all_pixels);
    {
      RasterStore::Hand hand(small);
      for (std::uint64_t t = 0; t < kTiles; ++t) fill_tile(hand, t, t % 8 != 0);
    }
    EXPECT_EQ(small.closed_tiles(), 35U);
    EXPECT_LT(small.spilled_bytes(), kTiles * kTileBytes / 2) << tiles;
    EXPECT_TRUE(take_all(small, kTiles) == expected) << tiles;
  }
}

/// Tiles that are open are in memory, while those that are closed go to the disk.
TEST_F(RasterStoreTest, PutsTilesOnTheDiskThatAreClosedBeforeOthers) {
  RasterStore store({PixelRule::kEqual}, 12 * kTileBytes, *scratch_, all_pixels);
  RasterStore::Hand hand(store);
  set_pixel(*hand.tile(1000), 7);
  hand.release();
  const float* const open = hand.tile(1000);
  hand.release();
  for (std::uint64_t t = 0; t < 100; ++t) fill_tile(hand, t);
  EXPECT_EQ(hand.tile(1000), open);
  EXPECT_EQ(*hand.tile(1000), 7);
}

/// A tile is taken as soon as it is closed, while other threads pack tiles and write them to the
/// disk.
TEST_F(RasterStoreTest, GivesTilesThatAreClosedWhileOthersArePainted) {
  constexpr std::uint64_t kTiles = 240;
  constexpr std::size_t kHalf = RasterStore::kTilePixels / 2;
  for (const std::uint64_t room : {0, 6, 30}) {
    std::mutex mutex;
    std::vector<std::uint64_t> closed;
    RasterStore store({PixelRule::kEqual}, room * kTileBytes, *scratch_, all_pixels,
                      [&](std::uint64_t number) {
                        const std::lock_guard lock(mutex);
                        closed.push_back(number);
                      });
    std::atomic<std::uint64_t> taken = 0;
    // Each half of a tile is painted by another thread.
    const auto paint = [&](std::size_t half) {
      RasterStore::Hand hand(store);
      for (std::uint64_t t = 0; t < kTiles; ++t) {
        const std::uint64_t number = half == 0 ? t : t ^ 7;
        float* const pixels = hand.tile(number);
        ASSERT_NE(pixels, nullptr);
        for (std::size_t i = half * kHalf; i < (half + 1) * kHalf; ++i) {
          set_pixel(pixels[i], static_cast<float>(number * 3 + half));
        }
        hand.decide(kHalf);
      }
    };
    const auto take = [&] {
      std::vector<float> pixels;
      while (taken < kTiles) {
        std::optional<std::uint64_t> number;
        {
          const std::lock_guard lock(mutex);
          if (!closed.empty()) {
            number = closed.back();
            closed.pop_back();
          }
        }
        if (!number) {
          std::this_thread::yield();
          continue;
        }
        store.take(*number, pixels);
        ++taken;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
          ASSERT_EQ(pixels[i], static_cast<float>(*number * 3 + i / kHalf)) << *number << ", " << i;
        }
      }
    };
    // Has pixels that others decide, and may come when the tile is taken.
    const auto come_late = [&] {
      RasterStore::Hand hand(store);
      for (std::uint64_t t = 0; t < kTiles; ++t) {
        float* const pixels = hand.tile(t);
        if (pixels != nullptr) set_pixel(pixels[7], static_cast<float>(t * 3));
      }
    };
    std::jthread first(paint, 0);
    std::jthread second(paint, 1);
    std::jthread third(come_late);
    std::jthread taker(take);
    taker.join();
    third.join();
    EXPECT_EQ(taken, kTiles);
    EXPECT_TRUE(store.tiles().empty());
  }
}

TEST_F(RasterStoreTest, LeavesATileClosedThatIsTaken) {
  RasterStore store({PixelRule::kEqual}, 30 * kTileBytes, *scratch_, all_pixels);
  RasterStore::Hand hand(store);
  fill_tile(hand, 5);
  hand.release();
  std::vector<float> pixels;
  store.take(5, pixels);
  EXPECT_EQ(hand.tile(5), nullptr);
  EXPECT_TRUE(store.tiles().empty());
  store.put_back(5, pixels);
  EXPECT_EQ(hand.tile(5), nullptr);
  EXPECT_EQ(store.tiles(), std::vector<std::uint64_t>{5});
  store.take(5, pixels);
  EXPECT_FALSE(std::isnan(pixels[0]));
  EXPECT_EQ(hand.tile(5), nullptr);
  EXPECT_TRUE(store.tiles().empty());
}

/// Another process goes on from what was saved in the midst, whatever was on the disk then, and
/// whatever the first one put there afterwards.
TEST_F(RasterStoreTest, GoesOnFromWhatWasSaved) {
  constexpr std::uint64_t kTiles = 25;
  namespace fs = std::filesystem;
  std::string folder = ::testing::TempDir() + "raster_store_test_XXXXXX";
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  const std::string file = folder + "/state";
  const std::vector<Put> puts = random_puts(3000, kTiles, 3);
  const std::vector<Put> first(puts.begin(), puts.begin() + 1700);
  const std::vector<Put> rest(puts.begin() + 1700, puts.end());
  RasterStore large(kAllRules, std::uint64_t{1} << 30, *scratch_);
  {
    RasterStore::Hand hand(large);
    fill_tile(hand, kTiles, true);
  }
  put_all(large, puts);
  const auto expected = take_all(large, kTiles + 1);
  const auto last_only = [](std::uint64_t number) {
    return number == kTiles ? std::uint32_t{RasterStore::kTilePixels} : 0;
  };
  for (const std::uint64_t tiles : {1, 12, 100}) {
    const std::uint64_t memory = tiles * kAllRules.size() * kTileBytes;
    {
      KeptScratchFolder scratch(folder + "/scratch", std::nullopt);
      RasterStore killed(kAllRules, memory, scratch, last_only);
      {
        RasterStore::Hand hand(killed);
        fill_tile(hand, kTiles, true);
      }
      put_all(killed, first);
      StateWriter writer(create_private_file(file, file));
      killed.save(writer);
      writer.finish();
      put_all(killed, rest);
    }
    KeptScratchFolder scratch(folder + "/scratch", std::nullopt);
    StateReader reader(disk().open(file), folder);
    reader.use_scratch(scratch);
    RasterStore store(kAllRules, memory, scratch, last_only);
    store.restore(reader);
    reader.finish();
    EXPECT_EQ(store.closed_tiles(), 1U);
    put_all(store, rest);
    EXPECT_TRUE(take_all(store, kTiles + 1) == expected) << tiles;
  }
  fs::remove_all(folder);
}

TEST_F(RasterStoreTest, NamesItsTilesInAscendingOrder) {
  RasterStore store({PixelRule::kEqual}, 0, *scratch_);
  {
    RasterStore::Hand hand(store);
    for (const std::uint64_t t : {40, 2, 17, 99, 3, 2, 8}) set_pixel(*hand.tile(t), 1);
  }
  EXPECT_THAT(store.tiles(), ElementsAre(2, 3, 8, 17, 40, 99));
}

TEST_F(RasterStoreTest, PutsPartsOfOtherStoresTogetherInAnyOrder) {
  constexpr std::uint64_t kTiles = 6;
  const std::vector<Put> puts = random_puts(1500, kTiles, 4);
  RasterStore whole(kAllRules, std::uint64_t{1} << 30, *scratch_);
  put_all(whole, puts);
  const auto expected = take_all(whole, kTiles);
  for (const bool last_first : {false, true}) {
    std::vector<std::vector<Put>> shares(3);
    for (std::size_t i = 0; i < puts.size(); ++i) shares[i % 3].push_back(puts[i]);
    if (last_first) std::reverse(shares.begin(), shares.end());
    RasterStore store(kAllRules, 0, *scratch_);
    put_all(store, shares[0]);
    std::vector<std::unique_ptr<RasterStore>> others;
    for (std::size_t s : {1, 2}) {
      others.push_back(std::make_unique<RasterStore>(kAllRules, 0, *scratch_));
      put_all(*others.back(), shares[s]);
    }
    for (std::uint64_t t = 0; t < kTiles; ++t) {
      const std::vector<std::vector<std::byte>> parts = {others[0]->take_tile(t),
                                                         others[1]->take_tile(t)};
      std::vector<float> pixels;
      store.take(t, pixels, parts);
      for (float& pixel : pixels) {
        if (std::isnan(pixel)) pixel = -1;
      }
      EXPECT_TRUE(pixels == expected[t]) << t;
    }
  }
}

TEST_F(RasterStoreTest, RefusesADamagedPartOfAnotherStore) {
  RasterStore store({PixelRule::kEqual}, kTileBytes, *scratch_);
  {
    RasterStore::Hand hand(store);
    set_pixel(*hand.tile(0), 1);
  }
  std::vector<std::vector<std::byte>> parts = {store.take_tile(0)};
  parts[0].back() ^= std::byte{1};
  try {
    std::vector<float> pixels;
    store.take(0, pixels, parts);
    ADD_FAILURE() << "the damage was not seen";
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), StartsWith("pixels from another rank")) << error.what();
  }
}

TEST(RasterStore, SaysWhenTheDiskIsFull) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), 300);
  RasterStore store({PixelRule::kEqual}, 0, *scratch);
  const ErrorFacts facts = facts_of([&store] {
    RasterStore::Hand hand(store);
    for (std::uint64_t t = 0; t < 100; ++t) set_pixel(*hand.tile(t), 1);
  });
  EXPECT_EQ(facts.remedy, Remedy::kScratchLimit);
}

TEST(RasterStore, NeedsRoomForEveryHandAndSome) {
  const std::uint64_t one = RasterStore::least_memory(1, 1);
  EXPECT_GT(one, RasterStore::kTilesInHand * kTileBytes);
  EXPECT_EQ(RasterStore::least_memory(3, 1), 3 * one);
  EXPECT_EQ(RasterStore::least_memory(1, 3) - one, 2 * RasterStore::kTilesInHand * kTileBytes);
}

}  // namespace
}  // namespace spillway::test
