#pragma once

#include <limits>
#include <string>
#include <vector>

#include "formats/bytes/bytes.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {

/// Everything that a reader gives, with all attributes.
struct Carried {
  PointHeader header;
  std::vector<LatticePoint> points;
  std::vector<std::uint64_t> index;
  std::vector<std::byte> records;  ///< of `layout`
  AttributeLayout layout;
  std::uint64_t invalid = 0;

  /// The numbers of an attribute of all points, those of an array one after the other.
  [[nodiscard]] std::vector<double> values(const std::string& name) const {
    std::vector<double> all;
    const AttributeField* const field = layout.find(name);
    if (field == nullptr) return all;
    const Attribute& attribute = field->attribute;
    for (std::size_t at = field->at; at < records.size(); at += layout.record_size()) {
      for (std::size_t e = 0; e < attribute.elements; ++e) {
        all.push_back(load_number(attribute.type, &records[at + e * size_of(attribute.type)]));
      }
    }
    return all;
  }
};

inline std::vector<std::string> names_of(const PointHeader& header) {
  std::vector<std::string> names;
  for (const Attribute& attribute : header.attributes.attributes()) names.push_back(attribute.name);
  return names;
}

/// Reads all with records of `layout`, or, if that is empty, of all attributes as the file has
/// them.
inline Carried read_carried(FileSystem& files, const std::string& path,
                            const PointReaderOptions& options = {},
                            const AttributeLayout& layout = {}) {
  const auto reader = open_point_reader(files, path, options);
  Carried all;
  all.header = reader->header();
  all.layout = layout.empty() ? all.header.attributes : layout;
  reader->carry(all.layout);
  PointBlock block;
  for (bool more = true; more;) {
    more = reader->read(block);
    all.points.insert(all.points.end(), block.points.begin(), block.points.end());
    all.index.insert(all.index.end(), block.index.begin(), block.index.end());
    all.records.insert(all.records.end(), block.attributes.begin(), block.attributes.end());
    all.invalid += block.invalid;
  }
  return all;
}

/// Likewise, `content` as a file of that name.
inline Carried read_carried(const std::string& path, const std::string& content,
                            const PointReaderOptions& options = {},
                            const AttributeLayout& layout = {}) {
  FaultyFileSystem files;
  files.files[path] = content;
  return read_carried(files, path, options, layout);
}

/// Makes sure that a file falls into several pieces, and that these, the last one first, hold what
/// it holds from front to back.
inline void expect_equal_pieces(const std::string& path, const std::string& content) {
  FaultyFileSystem files;
  files.files[path] = content;
  const Carried all = read_carried(files, path);
  const auto reader = open_point_reader(files, path, {});
  reader->carry(all.layout);
  ASSERT_GT(reader->pieces().value_or(0), 1U);
  std::vector<LatticePoint> points;
  std::vector<std::uint64_t> index;
  std::vector<std::byte> records;
  PointBlock block;
  for (std::uint64_t piece = *reader->pieces(); piece-- > 0;) {
    reader->begin_piece(piece);
    ASSERT_TRUE(reader->read(block));
    points.insert(points.begin(), block.points.begin(), block.points.end());
    index.insert(index.begin(), block.index.begin(), block.index.end());
    records.insert(records.begin(), block.attributes.begin(), block.attributes.end());
    EXPECT_FALSE(reader->read(block));
  }
  EXPECT_TRUE(points == all.points);
  EXPECT_TRUE(index == all.index);
  EXPECT_TRUE(records == all.records);
}

}  // namespace spillway::test
