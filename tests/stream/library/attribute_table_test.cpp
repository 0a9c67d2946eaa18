// What each point format makes of each kind of attribute: the table of docs/attributes.md.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spillway/convert.h>
#include <spillway/points.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "formats/bytes/number_type.h"
#include "tests/stream/library/call_test.h"
#include "tests/test_paths.h"

namespace spillway {
namespace {

constexpr auto kFiles = std::to_array<const char*>(
    {"a.las", "a.laz", "a.copc.laz", "a.spp", "a.npy", "a.ply", "a.csv", "a.txt"});

/// An attribute for each row: kinds of numbers, and names that LAS has a place for.
std::vector<Attribute> rows() {
  return {{.name = "small", .type = NumberType::kUint8},
          {.name = "signed", .type = NumberType::kInt32},
          {.name = "long", .type = NumberType::kInt64},
          {.name = "single", .type = NumberType::kFloat32},
          {.name = "double", .type = NumberType::kFloat64},
          {.name = "scaled", .type = NumberType::kInt16, .scale = 0.25, .offset = 100},
          {.name = "three", .type = NumberType::kFloat32, .elements = 3},
          {.name = "four", .type = NumberType::kInt16, .elements = 4},
          {.name = "classification", .type = NumberType::kInt32},
          {.name = "scan_angle", .type = NumberType::kFloat32},
          {.name = "gps_time", .type = NumberType::kFloat64}};
}

/// "uint16", "3 float32", "int16 * 0.25 + 100": the type of an attribute.
std::string type_text(const Attribute& attribute) {
  std::string text;
  if (attribute.elements != 1) text += fmt::format("{} ", attribute.elements);
  text += to_string(attribute.type);
  if (attribute.scale != 1) text += fmt::format(" * {}", attribute.scale);
  if (attribute.offset != 0) text += fmt::format(" + {}", attribute.offset);
  return text;
}

/// Small whole numbers, which every type holds.
AttributeColumns numbers_of(const Attribute& attribute, std::size_t points) {
  AttributeColumns columns({attribute}, points);
  formats::with_number_type(attribute.type, [&](auto number) {
    const auto values = columns.values<decltype(number)>(attribute.name);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<decltype(number)>(i % 20);
    }
  });
  return columns;
}

class AttributeTable : public test::CallTest {
 protected:
  /// In words, what becomes of an attribute in a file of that name.
  std::string outcome(const Attribute& attribute, const std::string& name) {
    const std::vector<Point<3>> points = {{0, 0, 0}, {1, 2, 3}, {4, 5, 6}};
    const AttributeColumns given = numbers_of(attribute, points.size());
    const Context context(options());
    PointFileOptions how;
    if (name.ends_with(".txt")) how.attributes = {"all"};
    try {
      convert(*points_in_memory(points, given), *create_points(file(name), how, context), context);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      return "refused";
    }
    const auto source = open_points({file(name)}, {.attributes = {"all"}}, context);
    PointsBlock block;
    EXPECT_TRUE(source->read(block));
    EXPECT_EQ(block.points, points);
    std::vector<Attribute> found = source->header().attributes;
    std::erase_if(found, [&](const Attribute& a) { return !a.name.starts_with(attribute.name); });
    if (found.empty()) return "lost";
    expect_numbers(block.attributes, found, given, attribute.name);
    if (found.size() == 1) return type_text(found.front());
    return fmt::format("{} columns of {}", found.size(), type_text(found.front()));
  }

  /// In one column, or in a column for each element.
  static void expect_numbers(const AttributeColumns& read, const std::vector<Attribute>& found,
                             const AttributeColumns& given, const std::string& name) {
    std::vector<double> numbers;
    const std::size_t elements = found.front().elements;
    for (std::size_t i = 0; i < read.size(); ++i) {
      for (const Attribute& part : found) {
        const std::vector<double> column = read.meant(part.name);
        for (std::size_t e = 0; e < elements; ++e) numbers.push_back(column[i * elements + e]);
      }
    }
    EXPECT_THAT(numbers, ::testing::Pointwise(::testing::DoubleNear(0.003), given.meant(name)));
  }
};

TEST_F(AttributeTable, OfTheDocumentationIsWhatFormatsDo) {
  std::string table = "| given | las, laz, copc | spp | npy | PLY | csv, text |\n";
  table += "|---|---|---|---|---|---|\n";
  for (const Attribute& attribute : rows()) {
    std::vector<std::string> outcomes;
    for (const char* const name : kFiles) outcomes.push_back(outcome(attribute, name));
    EXPECT_EQ(outcomes[1], outcomes[0]) << "LAZ, " << attribute.name;
    EXPECT_EQ(outcomes[2], outcomes[0]) << "COPC, " << attribute.name;
    EXPECT_EQ(outcomes[7], outcomes[6]) << "text, " << attribute.name;
    table +=
        fmt::format("| `{}`: {} | {} | {} | {} | {} | {} |\n", attribute.name, type_text(attribute),
                    outcomes[0], outcomes[3], outcomes[4], outcomes[5], outcomes[6]);
  }
  std::ifstream stream(test::docs_folder() / "attributes.md");
  const std::string page(std::istreambuf_iterator<char>(stream), {});
  EXPECT_THAT(page, ::testing::HasSubstr(table));
}

}  // namespace
}  // namespace spillway
