// GCC 12 sees an overlap that cannot be in the strings that Boost's gzip_compressor builds.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wrestrict"
#endif

#include <fmt/format.h>
#include <lz4frame.h>

#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <sstream>

#include "formats/points/spp/spp_format.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A frame as the lz4 tool makes it, with a checksum at its end.
std::string lz4_compressed(const std::string& content) {
  LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  std::string result(LZ4F_compressFrameBound(content.size(), &preferences), '\0');
  result.resize(LZ4F_compressFrame(result.data(), result.size(), content.data(), content.size(),
                                   &preferences));
  return result;
}

std::string compressed(const std::string& content, const std::string& extension) {
  if (extension == ".lz4") return lz4_compressed(content);
  std::ostringstream result;
  boost::iostreams::filtering_ostream stream;
  if (extension == ".gz") stream.push(boost::iostreams::gzip_compressor());
  if (extension == ".bz2") stream.push(boost::iostreams::bzip2_compressor());
  if (extension == ".zst") stream.push(boost::iostreams::zstd_compressor());
  stream.push(result);
  stream << content;
  stream.reset();
  return result.str();
}

std::string numbered_lines(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += fmt::format("{} {} {}\n", i, i * 7919 % 10007, i % 13);
  return text;
}

class CompressedText : public ::testing::TestWithParam<std::string> {
 protected:
  std::string extension_ = GetParam();
  std::string name_ = "a.xyz" + GetParam();
};

TEST_P(CompressedText, GivesTheSamePointsByExtension) {
  const AllPoints all = read_content(name_, compressed(numbered_lines(150000), extension_));
  ASSERT_EQ(all.points.size(), 150000U);
  EXPECT_EQ(all.points[149999], (LatticePoint{149999, 149999LL * 7919 % 10007, 149999 % 13}));
}

TEST_P(CompressedText, IsRecognisedByItsFirstBytes) {
  FaultyFileSystem files;
  files.seekable = false;
  files.files["-"] = compressed("1 2 3\n", extension_);
  EXPECT_EQ(read_all_points(files, "-").points.size(), 1U);
  EXPECT_EQ(read_content("a.xyz", files.files["-"]).points.size(), 1U);
}

TEST_P(CompressedText, OneStreamAfterAnother) {
  EXPECT_EQ(
      read_content(name_, compressed("1 2 3\n", extension_) + compressed("4 5 6\n", extension_))
          .points.size(),
      2U);
}

TEST_P(CompressedText, Truncated) {
  const std::string whole = compressed(numbered_lines(2000), extension_);
  for (std::size_t size = 10; size < whole.size(); size += 97) {
    EXPECT_THAT(error_of_content(name_, whole.substr(0, size)), HasSubstr("corrupt or ends early"));
  }
  EXPECT_THAT(error_of_content(name_, whole.substr(0, whole.size() - 1)),
              HasSubstr("corrupt or ends early"));
}

TEST_P(CompressedText, FollowedByGarbage) {
  EXPECT_THAT(error_of_content(name_, compressed("1 2 3\n", extension_) + "garbage garbage"),
              HasSubstr("corrupt or ends early"));
}

TEST_P(CompressedText, FlippedBits) {
  const std::string whole = compressed(numbered_lines(2000), extension_);
  for (std::size_t at = 0; at < whole.size(); at += 41) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(~flipped[at]);
    try {
      // Bits that carry no content (a time, an operating system) may flip unseen. Boost writes zstd
      // without a checksum, so there any bit may.
      const std::size_t points = read_content(name_, flipped).points.size();
      if (extension_ != ".zst") {
        EXPECT_EQ(points, 2000U) << at;
      }
    } catch (const Failure& error) {
      EXPECT_THAT(error.what(), HasSubstr(name_));
    }
  }
}

constexpr int kHollowLines = 10 << 10;

/// 80 MiB that compress as well as anything does.
const std::string& hollow_text() {
  static const std::string text = [] {
    const std::string line = "1 2 3" + std::string(8186, ' ') + "\n";
    std::string all;
    for (int i = 0; i < kHollowLines; ++i) all += line;
    return all;
  }();
  return text;
}

TEST_P(CompressedText, WhatExpandsWithoutEndIsAnError) {
  const std::string bomb = compressed(hollow_text(), extension_);
  EXPECT_THAT(error_of_content(name_, bomb, {.max_expansion = 20}),
              AllOf(HasSubstr("expands to more than 20 times its size"), HasSubstr("byte")));
  EXPECT_EQ(read_content(name_, bomb).points.size(), std::size_t{kHollowLines});
}

TEST_P(CompressedText, Empty) {
  EXPECT_THAT(error_of_content(name_, ""), HasSubstr("does not begin as its extension says"));
}

TEST_P(CompressedText, NotCompressed) {
  EXPECT_EQ(read_content(name_, "1 2 3\n").points.size(), 1U);
  EXPECT_THAT(error_of_content(name_, std::string("1 2\0 3\n", 7)),
              HasSubstr("does not begin as its extension says"));
}

TEST_P(CompressedText, NamedAsAnotherCompression) {
  for (const char* name : {"a.xyz.gz", "a.xyz.bz2", "a.xyz.zst", "a.xyz.lz4", "a.xyz"}) {
    EXPECT_EQ(read_content(name, compressed("1 2 3\n", extension_)).points.size(), 1U) << name;
  }
}

TEST_P(CompressedText, ContentThatIsNoTextOfPoints) {
  for (const std::string& content :
       {std::string("LASF"), std::string("\x93NUMPY"), std::string(kSppMagic)}) {
    EXPECT_THAT(error_of_content(name_, compressed(content, extension_)),
                HasSubstr("only text is read compressed"));
  }
  EXPECT_THAT(error_of_content(name_, compressed(compressed("1 2 3\n", extension_), extension_)),
              HasSubstr("only text is read compressed"));
  EXPECT_THAT(error_of_content(name_, compressed("OFF\n1 2 3\n", extension_)),
              HasSubstr("this is a mesh (OFF)"));
  EXPECT_THAT(error_of_content(name_, compressed(std::string("a\0b", 3), extension_)),
              HasSubstr("this is not text"));
}

TEST_P(CompressedText, OtherFormatsCompressed) {
  for (const char* inner : {"a.las", "a.LAZ", "a.npy", "a.spp"}) {
    EXPECT_THAT(error_of_content(inner + extension_, compressed("x", extension_)),
                HasSubstr("only text is read compressed"));
  }
}

INSTANTIATE_TEST_SUITE_P(All, CompressedText, ::testing::Values(".gz", ".bz2", ".zst", ".lz4"),
                         [](const auto& tested) { return tested.param.substr(1); });

TEST(CompressedZstd, WithoutChecksumTruncationIsSeen) {
  // Boost writes frames without a checksum, so nothing but the frame's own end tells completeness.
  const std::string whole = compressed("1 2 3\n4 5 6\n", ".zst");
  EXPECT_THAT(error_of_content("a.zst", whole.substr(0, whole.size() - 2)),
              HasSubstr("corrupt or ends early"));
}

/// Data from a pipe tells no size, so the window is what --long=31 asks for.
TEST(CompressedZstd, LargestWindow) {
  constexpr std::size_t kWindowDescriptor = 5;
  std::string whole = compressed(numbered_lines(2000), ".zst");
  ASSERT_EQ(whole[4] & 0x20, 0) << "a frame that tells its size has no window";
  whole[kWindowDescriptor] = static_cast<char>((31 - 10) << 3);
  EXPECT_EQ(read_content("a.zst", whole).points.size(), 2000U);
}

TEST(CompressedLz4, WithoutChecksumTruncationIsSeen) {
  std::string whole(100, '\0');
  const std::string text = "1 2 3\n4 5 6\n";
  whole.resize(LZ4F_compressFrame(whole.data(), whole.size(), text.data(), text.size(), nullptr));
  EXPECT_EQ(read_content("a.lz4", whole).points.size(), 2U);
  for (std::size_t size = 4; size < whole.size(); ++size) {
    EXPECT_THAT(error_of_content("a.lz4", whole.substr(0, size)),
                HasSubstr("corrupt or ends early"));
  }
}

}  // namespace
}  // namespace spillway::test
