#include "formats/points/npy/npy_writer.h"

#include <array>
#include <cstdint>
#include <utility>

#include "formats/points/attributes/further_coordinates.h"
#include "formats/points/attributes/unique_names.h"
#include "formats/points/npy/npy_fields.h"
#include "formats/points/npy/npy_header.h"
#include "formats/points/npy/npy_types.h"
#include "formats/points/rows/row_encoder.h"
#include "formats/points/rows/row_writer.h"

namespace spillway::formats {
namespace {

constexpr std::array<const char*, 3> kCoordinates = {"x", "y", "z"};

/// The fields of a structured array.
std::vector<NpyField> fields_of(int coordinates, const AttributeLayout& attributes) {
  std::vector<NpyField> fields;
  for (int axis = 0; axis < coordinates; ++axis) {
    fields.push_back({.name = kCoordinates[axis], .type = npy_type(NumberType::kFloat64)});
  }
  UniqueNames names({kCoordinates.begin(), kCoordinates.end()});
  append_npy_fields(fields, attributes, names);
  return fields;
}

/// The columns of an array without names: those of coordinates, if there is nothing else; or 0.
int columns_of(int coordinates, const AttributeLayout& attributes) {
  const int columns = coordinates + static_cast<int>(attributes.fields().size());
  const bool plain =
      attributes.empty() || (coordinates == kOwnAxes && attributes == further_coordinates(columns));
  return plain ? columns : 0;
}

}  // namespace

std::unique_ptr<PointWriter> open_npy_writer(std::unique_ptr<OutputFile> file,
                                             const PointWriterOptions& options) {
  RowFormat format{.attributes = without_scales(options.attributes), .header = {}};
  NpyHeader header;
  header.type = npy_type(NumberType::kFloat64);
  header.shape = {0};
  if (const int columns = columns_of(options.coordinates, format.attributes); columns > 0) {
    header.shape.push_back(static_cast<std::uint64_t>(columns));
  } else {
    header.fields = fields_of(options.coordinates, format.attributes);
  }
  format.header = [header, name = file->name()](std::uint64_t count) mutable {
    header.shape[0] = count;
    return npy_header_bytes(header, name);
  };
  return open_row_writer(std::move(file), options, std::move(format));
}

}  // namespace spillway::formats
