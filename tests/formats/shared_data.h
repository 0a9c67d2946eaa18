#pragma once
// Sample files outside of the repository, and what is documented of their points.

#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/formats/point_test_helpers.h"
#include "tests/formats/sha256.h"
#include "tests/test_paths.h"

namespace spillway::test {

inline std::filesystem::path shared_file(const char* name) { return shared_data_folder() / name; }

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The digest of all coordinates as int32 triples.
inline std::string sha256_of_points(const std::vector<LatticePoint>& points) {
  std::string integers;
  for (const LatticePoint& p : points) {
    integers += bytes_of(std::array<std::int32_t, 3>{static_cast<std::int32_t>(p[0]),
                                                     static_cast<std::int32_t>(p[1]),
                                                     static_cast<std::int32_t>(p[2])});
  }
  return sha256(integers);
}

/// A file and what all its points are, withheld ones included.
struct Sample {
  const char* file;
  std::uint64_t points;
  const char* sha256;
};

inline void PrintTo(const Sample& sample, std::ostream* out) { *out << sample.file; }

/// The test's name for a sample.
inline std::string name_of_sample(const ::testing::TestParamInfo<Sample>& tested) {
  std::string name = tested.param.file;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

inline constexpr const char* kAutzenPoints =
    "c29fb60ac342200ce4cf4ef97c8aa366e65fd83aef4abbafddee90e9224109cd";

}  // namespace spillway::test
