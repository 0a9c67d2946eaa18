// The rules of COPC, each broken in a file that is valid: the validator of the other tests sees it.

#include "tests/formats/points/copc/copc_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/formats/points/copc/written_copc.h"

namespace spillway::test {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;

constexpr std::size_t kInfo = 375 + 54;

template <typename T>
T value_at(const std::string& file, std::size_t byte) {
  T value;
  std::memcpy(&value, &file.at(byte), sizeof(T));
  return value;
}

/// A file of several nodes.
const std::string& valid_file() {
  static const std::string file = [] {
    std::mt19937 random(1);
    std::vector<LatticePoint> points(150'000);
    for (LatticePoint& p : points) {
      p = {double(random() % 3000), double(random() % 3000), double(random() % 50)};
    }
    return written_copc(points);
  }();
  return file;
}

std::size_t root_page(const std::string& file) { return value_at<std::uint64_t>(file, kInfo + 40); }

/// The entry of the hierarchy of that number.
std::size_t entry(const std::string& file, std::size_t number) {
  return root_page(file) + 32 * number;
}

/// A file that breaks a rule.
struct Broken {
  std::string rule;
  std::function<void(std::string& file)> by;
};

void add_to(std::string& file, std::size_t byte, auto difference) {
  put(file, byte,
      static_cast<decltype(difference)>(value_at<decltype(difference)>(file, byte) + difference));
}

const std::vector<Broken>& broken_files() {
  static const std::vector<Broken> all = {
      {"the file begins as LAS", [](std::string& f) { f[0] = 'l'; }},
      {"the version is 1.4", [](std::string& f) { f[25] = 3; }},
      {"the header has 375 bytes", [](std::string& f) { add_to(f, 94, std::uint16_t{1}); }},
      {"the point format is 6, 7 or 8", [](std::string& f) { f[104] = char(0x80 | 9); }},
      {"the points are compressed", [](std::string& f) { f[104] = 6; }},
      {"the coordinate system is WKT", [](std::string& f) { f[6] = 0; }},
      {"the legacy counts are 0", [](std::string& f) { f[107] = 1; }},
      {"records lie within the file",
       [](std::string& f) { put(f, 235, std::uint64_t{f.size() - 5}); }},
      {"the info record of 160 bytes is the first", [](std::string& f) { f[375 + 2] = 'x'; }},
      {"points follow the last record", [](std::string& f) { add_to(f, 96, std::uint32_t{1}); }},
      {"reserved numbers are 0", [](std::string& f) { f[kInfo + 100] = 1; }},
      {"no keys tell the coordinate system",
       [](std::string& f) {  // the record of the compression becomes one of keys
         f.replace(kInfo + 160 + 2, 16, std::string("LASF_Projection\0", 16));
         put(f, kInfo + 160 + 18, std::uint16_t{34735});
       }},
      {"a record tells of the compression",
       [](std::string& f) { put(f, kInfo + 160 + 18, std::uint16_t{1}); }},
      {"chunks are layered", [](std::string& f) { f[kInfo + 160 + 54] = 2; }},
      {"chunks are of variable size",
       [](std::string& f) { put(f, kInfo + 160 + 54 + 12, std::uint32_t{50000}); }},
      {"there is a hierarchy record",
       [](std::string& f) { put(f, root_page(f) - 60 + 18, std::uint16_t{1001}); }},
      {"the cube has a size", [](std::string& f) { put(f, kInfo + 24, 0.0); }},
      {"the spacing is a part of the cube", [](std::string& f) { put(f, kInfo + 32, 1e9); }},
      {"pages are entries within the hierarchy record",
       [](std::string& f) { add_to(f, kInfo + 48, std::uint64_t{32}); }},
      {"each page is referred to once",
       [](std::string& f) {
         put(f, entry(f, 1) + 16, std::uint64_t{root_page(f)});
         put(f, entry(f, 1) + 24, std::int32_t{32});
         put(f, entry(f, 1) + 28, std::int32_t{-1});
       }},
      {"a page tells of the node that it is of",
       [](std::string& f) { put(f, entry(f, 0), std::int32_t{7}); }},
      {"each node has one entry",
       [](std::string& f) { f.replace(entry(f, 1), 16, f.substr(entry(f, 0), 16)); }},
      {"keys are of the octree", [](std::string& f) { put(f, entry(f, 1) + 4, std::int32_t{5}); }},
      {"each node has its parent", [](std::string& f) { put(f, entry(f, 1), std::int32_t{3}); }},
      {"counts are not negative",
       [](std::string& f) { put(f, entry(f, 1) + 28, std::int32_t{-2}); }},
      {"empty nodes have no chunk",
       [](std::string& f) { put(f, entry(f, 1) + 28, std::int32_t{0}); }},
      {"nodes have all points", [](std::string& f) { add_to(f, entry(f, 1) + 28, 1); }},
      {"chunks lie one behind the other", [](std::string& f) { add_to(f, entry(f, 1) + 24, -1); }},
      {"the chunk table follows the chunks",
       [](std::string& f) { add_to(f, value_at<std::uint32_t>(f, 96), std::uint64_t{1}); }},
      {"the chunk table lists the nodes", [](std::string& f) { add_to(f, entry(f, 1) + 28, 1); }},
      {"the header counts the points", [](std::string& f) { add_to(f, 247, std::uint64_t{1}); }},
      {"the header counts the returns", [](std::string& f) { add_to(f, 255, std::uint64_t{1}); }},
      {"the header has the bounds of the points", [](std::string& f) { put(f, 179, 1e6); }},
      {"the cube has all points", [](std::string& f) { put(f, kInfo + 24, 100.0); }},
      {"the info record has the first and the last time",
       [](std::string& f) { put(f, kInfo + 64, 1.0); }},
      {"points lie in the cube of their node",
       [](std::string& f) {
         const auto key = f.substr(entry(f, 1), 16);
         f.replace(entry(f, 1), 16, f.substr(entry(f, 2), 16));
         f.replace(entry(f, 2), 16, key);
       }},
  };
  return all;
}

TEST(CopcFaults, AreNoneInAValidFile) { EXPECT_THAT(copc_faults(valid_file()), IsEmpty()); }

TEST(CopcFaults, AreSeenForEachRule) {
  for (const Broken& broken : broken_files()) {
    std::string file = valid_file();
    broken.by(file);
    EXPECT_THAT(copc_faults(file), Contains(broken.rule));
  }
}

}  // namespace
}  // namespace spillway::test
