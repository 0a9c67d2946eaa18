#include "stream/source/point_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "formats/bytes/number_type.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

/// "1, 3-5, 9": the numbers of the bits that are set.
std::string list_text(const std::bitset<256>& bits) {
  std::string text;
  for (std::size_t first = 0; first < bits.size(); ++first) {
    if (!bits.test(first)) continue;
    std::size_t last = first;
    while (last + 1 < bits.size() && bits.test(last + 1)) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", first);
    if (last > first) text += fmt::format("-{}", last);
    first = last;
  }
  return text;
}

/// Which ones the other classes are is of use where they are all there is.
std::string other_classes_text(const PointCounts& counts) {
  if (counts.kept() > 0 || counts.other_classes.none()) return "of other classes";
  return fmt::format("of other classes ({})", list_text(counts.other_classes));
}

constexpr const char* kClassification = "classification";
constexpr const char* kReturnNumber = "return_number";
constexpr const char* kNumberOfReturns = "number_of_returns";

/// An attribute of small whole numbers; 0 where there is none.
class ByteField {
 public:
  ByteField(const AttributeLayout& layout, std::string_view name) : size_(layout.record_size()) {
    const AttributeField* const field = layout.find(name);
    if (field == nullptr) return;
    at_ = field->at;
    type_ = field->attribute.type;
    known_ = true;
  }

  [[nodiscard]] std::uint8_t of(const std::byte* records, std::size_t i) const {
    if (!known_) return 0;
    const std::byte* const number = records + i * size_ + at_;
    if (type_ == NumberType::kUint8) return load<std::uint8_t>(number);
    const double value = load_number(type_, number);
    return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
  }

 private:
  std::size_t size_;
  std::size_t at_ = 0;
  NumberType type_ = NumberType::kUint8;
  bool known_ = false;
};

/// 0 to 2 for a coordinate, -1 for other names.
int axis_of(std::string_view name) {
  constexpr std::string_view kAxes = "xyz";
  return name.size() == 1 ? static_cast<int>(kAxes.find(name[0]) + 1) - 1 : -1;
}

/// The numbers of that name of all points: output coordinates, or what attributes mean.
std::vector<double> column_of(const std::string& name, const std::optional<IntegerLattice>& lattice,
                              const AttributeLayout& layout, const PointBlock& block) {
  std::vector<double> column(block.size());
  const int axis = axis_of(name);
  const AttributeField* const field = layout.find(name);
  for (std::size_t i = 0; i < block.size(); ++i) {
    if (axis >= 0) {
      column[i] = in_world(lattice, block.points[i])[axis];
    } else if (field != nullptr) {
      const Attribute& attribute = field->attribute;
      const std::byte* const number = &block.attributes[i * layout.record_size() + field->at];
      column[i] = load_number(attribute.type, number) * attribute.scale + attribute.offset;
    }
  }
  return column;
}

bool keeps(const ClipArea& area, const WorldPoint& point) {
  return area.keeps({point[0], point[1]});
}

std::vector<bool> where_holds(const Condition& where, const std::optional<IntegerLattice>& lattice,
                              const AttributeLayout& layout, const PointBlock& block) {
  std::vector<std::vector<double>> columns;
  for (const std::string& name : where.names()) {
    columns.push_back(column_of(name, lattice, layout, block));
  }
  return where.holds(columns, block.size());
}

}  // namespace

bool ReturnFilter::keeps(std::uint8_t number, std::uint8_t count_of_pulse) const {
  const bool known = number > 0 && count_of_pulse > 0;
  const bool is_first = number <= 1;
  const bool is_last = !known || number >= count_of_pulse;
  return (first && is_first) || (last && is_last) || (single && is_first && is_last) ||
         (number < numbers.size() && numbers[number]);
}

std::vector<std::string> PointFilter::attributes() const {
  std::vector<std::string> names;
  if (classes) names.emplace_back(kClassification);
  if (returns) names.insert(names.end(), {kReturnNumber, kNumberOfReturns});
  if (where) {
    std::ranges::copy_if(where->names(), std::back_inserter(names),
                         [](const std::string& name) { return axis_of(name) < 0; });
  }
  return names;
}

std::optional<Box<3>> PointFilter::box() const {
  const std::optional<Box<2>> area = clip ? clip->box() : std::nullopt;
  if (!area) return bounds;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Box<3> column = {{area->lo[0], area->lo[1], -kInfinity},
                         {area->hi[0], area->hi[1], kInfinity}};
  return bounds ? common_part(column, *bounds) : column;
}

std::optional<Box<3>> PointFilter::loose_box() const {
  constexpr double kMargin = 1e-12;
  std::optional<Box<3>> loose = box();
  if (!loose) return loose;
  for (int k = 0; k < 3; ++k) {
    loose->lo[k] -= std::abs(loose->lo[k]) * kMargin;
    loose->hi[k] += std::abs(loose->hi[k]) * kMargin;
  }
  return loose;
}

void refuse_empty_input(const PointCounts& counts) {
  if (counts.read == 0) {
    throw Failure(counts.lost == 0
                      ? std::string("the input has no points")
                      : fmt::format("all {} points of the input are lost", counts.lost),
                  ErrorCode::kDegenerateInput);
  }
  throw Failure("the filters leave no points: " + describe(counts), ErrorCode::kDegenerateInput);
}

void apply_filter(const PointFilter& filter, const std::optional<IntegerLattice>& lattice,
                  const AttributeLayout& layout, PointBlock& block, PointCounts& counts) {
  const ByteField classification(layout, kClassification);
  const ByteField number(layout, kReturnNumber);
  const ByteField count_of_pulse(layout, kNumberOfReturns);
  const std::byte* const records = block.attributes.data();
  std::vector<bool> wanted;
  if (filter.where) wanted = where_holds(*filter.where, lattice, layout, block);
  std::vector<bool> kept(block.size());
  for (std::size_t i = 0; i < block.size(); ++i) {
    if (filter.every > 1 && block.index[i] % filter.every != 0) {
      ++counts.skipped;
    } else if (filter.classes && !filter.classes->test(classification.of(records, i))) {
      ++counts.classes;
      counts.other_classes.set(classification.of(records, i));
    } else if (filter.returns &&
               !filter.returns->keeps(number.of(records, i), count_of_pulse.of(records, i))) {
      ++counts.returns;
    } else if (filter.where && !wanted[i]) {
      ++counts.where;
    } else if (filter.bounds && !filter.bounds->contains(in_world(lattice, block.points[i]))) {
      ++counts.bounds;
    } else if (filter.clip && !keeps(*filter.clip, in_world(lattice, block.points[i]))) {
      ++counts.clip;
    } else {
      kept[i] = true;
    }
  }
  block.keep([&](std::size_t i) { return kept[i]; });
}

}  // namespace spillway::stream

namespace spillway {

std::string describe(const PointCounts& counts) {
  std::string text = fmt::format("{} points read", counts.read);
  if (counts.lost > 0) {
    text += fmt::format(" ({} {} lost)", counts.lost, counts.lost == 1 ? "is" : "are");
  }
  const std::array<std::pair<std::uint64_t, std::string>, 9> dropped = {
      {{counts.invalid, "invalid"},
       {counts.withheld, "withheld"},
       {counts.skipped, "skipped"},
       {counts.classes, stream::other_classes_text(counts)},
       {counts.returns, "of other returns"},
       {counts.where, "for which the condition does not hold"},
       {counts.bounds, "outside the bounds"},
       {counts.clip, "clipped"},
       {counts.thinned, "thinned"}}};
  for (const auto& [count, why] : dropped) {
    if (count > 0) text += fmt::format(", {} {}", count, why);
  }
  text += fmt::format(", {} kept", counts.kept());
  if (counts.wrapped > 0) {
    text += fmt::format(", {} of them brought into the periodic box", counts.wrapped);
  }
  return text;
}

}  // namespace spillway
