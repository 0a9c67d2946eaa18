// The table of point formats, and that one more line in it is enough for another format.

#include "formats/points/point_formats.h"

#include <fmt/format.h>

#include <set>
#include <sstream>

#include "formats/bytes/bytes.h"
#include "formats/bytes/whole_file.h"
#include "formats/points/create_points.h"
#include "formats/points/las/las_format.h"
#include "formats/points/text/text_format.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(PointFormatTable, NamesAreDistinct) {
  std::set<std::string_view> names;
  for (const PointFormat* const format : point_formats()) {
    EXPECT_TRUE(names.insert(format->name).second) << format->name;
    EXPECT_FALSE(format->title.empty()) << format->name;
    EXPECT_EQ(point_format_by_name(format->name), *format);
  }
}

TEST(PointFormatTable, NoExtensionIsOfTwoFormats) {
  std::set<std::string_view> extensions;
  for (const PointFormat* const format : point_formats()) {
    for (const std::string_view extension : format->extensions) {
      EXPECT_TRUE(extensions.insert(extension).second) << extension;
      EXPECT_EQ(point_format_of_path("a." + std::string(extension)), format);
    }
  }
}

TEST(PointFormatTable, EachFormatIsReadInOneWay) {
  for (const PointFormat* const format : point_formats()) {
    EXPECT_NE(format->open_reader != nullptr, format->las_variant != nullptr) << format->name;
  }
}

TEST(PointFormatTable, OneFormatIsText) {
  EXPECT_EQ(std::ranges::count_if(point_formats(), &PointFormat::is_text), 1);
}

TEST(PointFormatTable, ListsForMessagesAreInItsOrder) {
  EXPECT_EQ(list_of_points(is_written, "or"), "LAS, LAZ, COPC, text, npy, PLY or spp");
  EXPECT_THAT(point_extensions(), ElementsAre(".las", ".laz", ".copc.laz", ".txt", ".xyz", ".csv",
                                              ".asc", ".npy", ".ply", ".pcd", ".spp"));
}

// A format as its folder would have it: "TOY" and coordinates.

class ToyReader : public PointReader {
 public:
  explicit ToyReader(PointInput input) : text_{std::string(as_text(read_whole(*input.source)))} {
    header_.name = input.path;
    header_.format = "toy";
    std::string word;
    text_ >> word;
  }

  [[nodiscard]] const PointHeader& header() const override { return header_; }
  bool fetch(RawPoints& raw) override {
    for (LatticePoint p; text_ >> p[0] >> p[1] >> p[2];) {
      raw.decoded.index.push_back(raw.decoded.points.size());
      raw.decoded.points.push_back(p);
    }
    return raw.decoded.size() > 0;
  }
  [[nodiscard]] std::optional<double> fraction_read() const override { return std::nullopt; }

 private:
  std::istringstream text_;
  PointHeader header_;
};

class ToyWriter : public PointWriter {
 public:
  explicit ToyWriter(std::unique_ptr<OutputFile> file) : file_(std::move(file)) { put("TOY\n"); }

  void write(std::span<const LatticePoint> points,
             std::span<const std::byte> /*attributes*/) override {
    for (const LatticePoint& p : points) put(fmt::format("{} {} {}\n", p[0], p[1], p[2]));
  }
  void finish() override { file_->commit(); }

 private:
  void put(const std::string& text) { file_->write(as_bytes_of(text)); }

  std::unique_ptr<OutputFile> file_;
};

constexpr std::string_view kToyExtensions[] = {"toy"};

constinit const PointFormat kToyPoints = {
    .name = "toy",
    .title = "TOY",
    .extensions = kToyExtensions,
    .recognises = [](std::string_view text) { return text.starts_with("TOY\n"); },
    .open_reader = [](PointInput input, const PointReaderOptions& /*options*/)
        -> std::unique_ptr<PointReader> { return std::make_unique<ToyReader>(std::move(input)); },
    .open_writer = [](std::unique_ptr<OutputFile> file, const std::string& /*path*/,
                      const PointWriterOptions& /*options*/) -> std::unique_ptr<PointWriter> {
      return std::make_unique<ToyWriter>(std::move(file));
    },
};

constexpr const PointFormat* kTable[] = {&kLasPoints, &kTextPoints, &kToyPoints};

TEST(AnotherPointFormat, IsWrittenByItsExtensionAndReadByItsFirstBytes) {
  FaultyFileSystem files;
  const std::vector<LatticePoint> points = {{1, 2, 3}, {4.5, -6, 1e300}};
  const auto writer = open_point_writer(files, "a.toy", {}, kTable);
  writer->write(points, {});
  writer->finish();
  files.files["a.txt"] = files.files["a.toy"];
  for (const char* const name : {"a.toy", "a.txt"}) {
    const auto reader = open_point_reader(files, name, {}, kTable);
    EXPECT_EQ(reader->header().format, "toy");
    PointBlock block;
    ASSERT_TRUE(reader->read(block));
    EXPECT_EQ(block.points, points);
    EXPECT_FALSE(reader->read(block));
  }
}

TEST(AnotherPointFormat, StandsInMessages) {
  FaultyFileSystem files;
  EXPECT_THAT(error_of([&] { open_point_writer(files, "a", {}, kTable); }),
              HasSubstr("end it in .las, .txt, .xyz, .csv, .asc or .toy"));
  files.files["a"] = std::string("\x7f\0\0", 3);
  EXPECT_THAT(error_of([&] { open_point_reader(files, "a", {}, kTable); }),
              HasSubstr("neither as LAS nor as TOY nor as text"));
  PointReaderOptions named;
  named.format = "ply";
  EXPECT_THAT(error_of([&] { open_point_reader(files, "a", named, kTable); }),
              HasSubstr("choose las, text or toy"));
}

}  // namespace
}  // namespace spillway::test
