#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "formats/inputs/open_points.h"
#include "formats/points/common/point_reader.h"
#include "src/error.h"
#include "tests/faulty_file_system.h"
#include "tests/formats/points/las_flags_layout.h"

namespace spillway::test {

/// Everything that a reader gives.
struct AllPoints {
  PointHeader header;
  std::vector<LatticePoint> points;
  std::vector<std::uint64_t> index;
  std::vector<LasFlags> attributes;
  std::uint64_t withheld = 0;
  std::uint64_t lost = 0;            ///< as blocks told
  std::vector<std::string> notices;  ///< that came with blocks
};

/// Adds what a block tells besides its points.
inline void add_counts(const PointBlock& block, AllPoints& all) {
  all.withheld += block.withheld;
  all.lost += block.lost;
  all.notices.insert(all.notices.end(), block.notices.begin(), block.notices.end());
}

/// `flags`: with what LAS says of points in few bytes.
inline AllPoints read_all_points(FileSystem& files, const std::string& path,
                                 const PointReaderOptions& options = {}, bool flags = false) {
  const auto reader = open_point_reader(files, path, options);
  if (flags) reader->carry(flags_layout());
  AllPoints all;
  all.header = reader->header();
  PointBlock block;
  while (reader->read(block)) {
    EXPECT_GT(block.size(), 0U);
    EXPECT_EQ(block.points.size(), block.index.size());
    all.points.insert(all.points.end(), block.points.begin(), block.points.end());
    all.index.insert(all.index.end(), block.index.begin(), block.index.end());
    const std::vector<LasFlags> some = flags_of(block.attributes);
    all.attributes.insert(all.attributes.end(), some.begin(), some.end());
    add_counts(block, all);
  }
  EXPECT_EQ(block.size(), 0U);
  add_counts(block, all);
  return all;
}

/// Reads `content` as a file of that name.
inline AllPoints read_content(const std::string& path, const std::string& content,
                              const PointReaderOptions& options = {}, bool flags = false) {
  FaultyFileSystem files;
  files.files[path] = content;
  return read_all_points(files, path, options, flags);
}

/// The message of the Failure that `action` throws; a failure of the test if it throws none. A
/// message is one line.
template <typename F>
std::string error_of(F&& action) {
  try {
    action();
  } catch (const Failure& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  ADD_FAILURE() << "no Error was thrown";
  return "";
}

/// The message that reading `content` as a file of that name ends with.
inline std::string error_of_content(const std::string& path, const std::string& content,
                                    const PointReaderOptions& options = {}) {
  return error_of([&] { read_content(path, content, options); });
}

/// The bytes of a value.
template <typename T>
std::string bytes_of(const T& value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

/// Overwrites bytes of `content` by a value.
template <typename T>
void put(std::string& content, std::size_t at, const T& value) {
  ASSERT_LE(at + sizeof(T), content.size());
  std::memcpy(&content[at], &value, sizeof(T));
}

}  // namespace spillway::test
