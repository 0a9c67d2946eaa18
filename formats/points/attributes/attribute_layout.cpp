#include "formats/points/attributes/attribute_layout.h"

#include <algorithm>
#include <utility>

namespace spillway::formats {
namespace {

bool same_scale(const Attribute& a, const Attribute& b) {
  return a.scale == b.scale && a.offset == b.offset;
}

/// The least type that holds all numbers of both; doubles if no integer does.
NumberType common_type(NumberType a, NumberType b) {
  if (a == b) return a;
  if (!is_integer(a) || !is_integer(b)) return NumberType::kFloat64;
  const bool is_signed = is_signed_integer(a) || is_signed_integer(b);
  std::size_t bytes = 0;
  for (const NumberType type : {a, b}) {
    const bool grows = is_signed && !is_signed_integer(type);
    bytes = std::max(bytes, size_of(type) * (grows ? 2 : 1));
  }
  for (const NumberType type :
       {NumberType::kInt8, NumberType::kUint8, NumberType::kInt16, NumberType::kUint16,
        NumberType::kInt32, NumberType::kUint32, NumberType::kInt64, NumberType::kUint64}) {
    if (is_signed_integer(type) == is_signed && size_of(type) == bytes) return type;
  }
  return NumberType::kFloat64;
}

/// What holds the numbers of both: doubles of what is meant, unless both mean the same by them.
Attribute common_attribute(Attribute a, const Attribute& b) {
  a.elements = std::max(a.elements, b.elements);
  if (a.unit != b.unit) a.unit.clear();
  if (a.description != b.description) a.description.clear();
  if (same_scale(a, b)) {
    a.type = common_type(a.type, b.type);
    return a;
  }
  a.type = NumberType::kFloat64;
  a.scale = 1;
  a.offset = 0;
  return a;
}

}  // namespace

AttributeLayout::AttributeLayout(std::vector<Attribute> attributes) {
  if (attributes.empty()) return;
  auto shared = std::make_shared<Shared>();
  for (Attribute& attribute : attributes) {
    const std::size_t size = size_of(attribute);
    shared->fields.push_back({std::move(attribute), shared->record_size});
    shared->record_size += size;
  }
  shared_ = std::move(shared);
}

std::span<const AttributeField> AttributeLayout::fields() const {
  return shared_ ? std::span<const AttributeField>(shared_->fields)
                 : std::span<const AttributeField>();
}

const AttributeField* AttributeLayout::find(std::string_view name) const {
  const auto field = std::ranges::find_if(
      fields(), [name](const AttributeField& f) { return f.attribute.name == name; });
  return field == fields().end() ? nullptr : &*field;
}

std::vector<Attribute> AttributeLayout::attributes() const {
  std::vector<Attribute> all;
  for (const AttributeField& field : fields()) all.push_back(field.attribute);
  return all;
}

bool AttributeLayout::operator==(const AttributeLayout& other) const {
  return shared_ == other.shared_ ||
         std::ranges::equal(fields(), other.fields(), {}, &AttributeField::attribute,
                            &AttributeField::attribute);
}

AttributeLayout joined(std::span<const AttributeLayout> layouts) {
  if (layouts.empty()) return {};
  const auto differs = [&](const AttributeLayout& layout) { return !(layout == layouts[0]); };
  if (std::ranges::none_of(layouts, differs)) return layouts[0];
  std::vector<Attribute> all;
  for (const AttributeLayout& layout : layouts) {
    for (const AttributeField& field : layout.fields()) {
      const auto known = std::ranges::find(all, field.attribute.name, &Attribute::name);
      if (known == all.end()) {
        all.push_back(field.attribute);
      } else {
        *known = common_attribute(std::move(*known), field.attribute);
      }
    }
  }
  return AttributeLayout(std::move(all));
}

AttributeLayout chosen(const AttributeLayout& layout, const AttributeChoice& choice) {
  if (choice.all) return layout;
  std::vector<Attribute> wanted;
  for (const AttributeField& field : layout.fields()) {
    if (std::ranges::find(choice.names, field.attribute.name) != choice.names.end()) {
      wanted.push_back(field.attribute);
    }
  }
  return AttributeLayout(std::move(wanted));
}

}  // namespace spillway::formats
