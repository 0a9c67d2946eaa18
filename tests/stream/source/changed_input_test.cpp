#include "stream/source/changed_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "tests/error_facts.h"
#include "tests/formats/inputs/temporary_files.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// A reader that knows a header and nothing else.
class HeaderOnly : public PointReader {
 public:
  explicit HeaderOnly(PointHeader header) : header_(std::move(header)) {}
  [[nodiscard]] const PointHeader& header() const override { return header_; }
  bool fetch(RawPoints&) override { return false; }
  [[nodiscard]] std::optional<double> fraction_read() const override { return std::nullopt; }

 private:
  PointHeader header_;
};

PointHeader header() {
  PointHeader header;
  header.name = "a.las";
  header.format = "las";
  header.version = "1.2";
  header.point_format = 3;
  header.count = 1000;
  header.lattice = IntegerLattice{};
  header.extent = Box<3>{{0, 0, 0}, {10, 10, 10}};
  header.crs = std::string("EPSG:25832");
  header.regions = {{{{0, 0, 0}, {5, 10, 10}}, 400}, {{{5, 0, 0}, {10, 10, 10}}, 600}};
  return header;
}

SourceFacts::Input surveyed() {
  SourceFacts::Input input;
  input.header = header();
  return input;
}

/// What is said of an input that had this header; "" if it passes.
std::string refusal(const std::function<void(PointHeader&)>& change) {
  PointHeader now = header();
  change(now);
  const auto error =
      thrown_by([&] { refuse_changed_input(surveyed(), "no such file", HeaderOnly(now)); });
  if (!error) return "";
  EXPECT_EQ(error->code(), ErrorCode::kBadInput);
  EXPECT_EQ(error->facts().file, "a.las");
  return error->what();
}

TEST(RefuseChangedInput, ThatTellsTheSameOfItsPointsPasses) {
  EXPECT_EQ(refusal([](PointHeader&) {}), "");
  EXPECT_EQ(refusal([](PointHeader& now) { now.software = "another program"; }), "");
}

TEST(RefuseChangedInput, IsRefusedWithWhatIsOtherThanItWas) {
  EXPECT_THAT(refusal([](PointHeader& now) { now.format = "laz"; }),
              HasSubstr("a.las: the file has changed since its header was read: the format is laz, "
                        "not las; run again"));
  for (const auto& kind : {std::function([](PointHeader& now) { now.version = "1.4"; }),
                           std::function([](PointHeader& now) { now.point_format = 7; })}) {
    EXPECT_THAT(refusal(kind), HasSubstr("its records are of another kind"));
  }
  EXPECT_THAT(refusal([](PointHeader& now) { now.lattice->offset[2] = 1; }),
              HasSubstr("another scale or offset"));
  EXPECT_THAT(refusal([](PointHeader& now) { now.lattice.reset(); }),
              HasSubstr("another scale or offset"));
  EXPECT_THAT(refusal([](PointHeader& now) { now.coordinates = 2; }),
              HasSubstr("its points have 2 coordinates, not 3"));
  EXPECT_THAT(refusal([](PointHeader& now) { now.count = 1001; }),
              HasSubstr("it has 1001 points, not 1000"));
  EXPECT_THAT(refusal([](PointHeader& now) { now.count.reset(); }),
              HasSubstr("its number of points is told otherwise"));
  EXPECT_THAT(refusal([](PointHeader& now) { now.crs = std::string(); }),
              HasSubstr("another coordinate system"));
}

/// All else is planned by these: points outside of their region would be lost.
TEST(RefuseChangedInput, IsRefusedWhereItsPointsLieElsewhere) {
  for (const auto& move :
       {std::function([](PointHeader& now) { now.extent->hi[0] = 11; }),
        std::function([](PointHeader& now) { now.regions[1].box.lo[0] = 4; }),
        std::function([](PointHeader& now) { std::swap(now.regions[0], now.regions[1]); }),
        std::function([](PointHeader& now) { now.regions[0].count = 401; }),
        std::function([](PointHeader& now) { now.regions.pop_back(); }),
        std::function([](PointHeader& now) { now.regions_are_exact = true; })}) {
    EXPECT_THAT(refusal(move), HasSubstr("its points lie elsewhere"));
  }
}

TEST(RefuseChangedInput, OfAnotherSizeIsRefused) {
  const TemporaryFiles files;
  const std::string path = files.put("input", "twelve bytes");
  EXPECT_EQ(bytes_of_file(path), 12U);
  const auto refused = [&](std::optional<std::uint64_t> bytes) {
    SourceFacts::Input input = surveyed();
    input.bytes = bytes;
    const auto error = thrown_by([&] { refuse_changed_input(input, path, HeaderOnly(header())); });
    return error ? std::string(error->what()) : "";
  };
  EXPECT_EQ(refused(12), "");
  EXPECT_EQ(refused(std::nullopt), "") << "a pipe";
  EXPECT_THAT(refused(13), HasSubstr("it has 12 bytes, not 13"));
  std::filesystem::remove(path);
  EXPECT_EQ(bytes_of_file(path), std::nullopt);
  EXPECT_EQ(bytes_of_file(::testing::TempDir()), std::nullopt) << "a folder";
}

}  // namespace
}  // namespace spillway::test
