#include "formats/meshes/npy/npy_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

#include "formats/bytes/buffered_input.h"
#include "formats/bytes/number_type.h"
#include "formats/meshes/common/periodic_mesh.h"
#include "formats/points/attributes/further_coordinates.h"
#include "formats/points/attributes/record_conversion.h"
#include "formats/points/npy/npy_header.h"
#include "formats/points/npy/npy_layout.h"
#include "src/error.h"
#include "src/geometry/simplex_name.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtension = ".npy";
constexpr std::string_view kVertices = "_vertices";
constexpr std::string_view kSimplices = "_simplices";
constexpr std::string_view kInputIndex = "_input_index";
constexpr std::string_view kAttributes = "_attributes";
constexpr std::string_view kOffsets = "_offsets";
constexpr std::string_view kBox = "_box";

std::string without(std::string_view path, std::string_view end) {
  return std::string(path.ends_with(end) ? path.substr(0, path.size() - end.size()) : path);
}

struct NamedType {
  std::string_view name;  // without the sign of the byte order
  NumberType type;
};

constexpr std::array kTypes = {
    NamedType{"f8", NumberType::kFloat64}, NamedType{"f4", NumberType::kFloat32},
    NamedType{"i8", NumberType::kInt64},   NamedType{"u8", NumberType::kUint64},
    NamedType{"i4", NumberType::kInt32},   NamedType{"u4", NumberType::kUint32}};

constexpr NamedType kByte = {"i1", NumberType::kInt8};

/// Makes sure that the rows of an array, and nothing else, are in the file from where `source`
/// stands, if its size is known: then it returns true.
bool check_room(const InputBytes& source, std::uint64_t rows, std::uint64_t each) {
  const std::optional<std::uint64_t> size = source.size();
  if (!size) return false;
  const std::uint64_t room = *size - std::min(*size, source.position());
  if (rows > room / each || rows * each != room) {
    throw BadInput(source.name(),
                   fmt::format("the header says {} rows of {} bytes, but {} bytes follow it; get a "
                               "complete copy",
                               rows, each, room),
                   at_byte(source.position()));
  }
  return true;
}

/// One array of up to three dimensions being read.
class ArrayInput {
 public:
  /// Bytes are read only if `takes_bytes`.
  ArrayInput(FileSystem& files, const std::string& path, bool takes_bytes = false)
      : source_(files.open(path)), header_(read_npy_header(source_)) {
    if (takes_bytes && header_.type.substr(header_.type.empty() ? 0 : 1) == kByte.name) {
      type_ = kByte.type;
    } else {
      choose_type();
    }
    if (header_.fortran_order) {
      fail("the array is in Fortran order; save numpy.ascontiguousarray(a)");
    }
  }

  [[nodiscard]] std::uint64_t rows() const { return header_.shape[0]; }
  [[nodiscard]] std::uint64_t columns() const { return header_.shape[1]; }
  [[nodiscard]] NumberType type() const { return type_; }

  /// Demands a shape of n x `least` to n x `most`; n alone if both are 0.
  void check_shape(std::uint64_t least, std::uint64_t most) const {
    const std::vector<std::uint64_t>& shape = header_.shape;
    const bool flat = most == 0;
    if (shape.size() != (flat ? 1 : 2) || (!flat && (shape[1] < least || shape[1] > most))) {
      fail(fmt::format("the array has shape ({}), but {} is needed", fmt::join(shape, ", "),
                       flat ? "n" : fmt::format("n x {} to n x {}", least, most)));
    }
  }

  /// Demands exactly that shape.
  void check_exact_shape(const std::vector<std::uint64_t>& shape) const {
    if (header_.shape == shape) return;
    fail(fmt::format("the array has shape ({}), but ({}) is needed; it is of another mesh",
                     fmt::join(header_.shape, ", "), fmt::join(shape, ", ")));
  }

  /// Demands real numbers.
  void check_reals() const {
    if (is_integer(type_)) {
      fail(
          fmt::format("the array has elements of type '{}', but coordinates are 'f8' or 'f4'; save "
                      "a.astype('<f8')",
                      header_.type));
    }
  }

  /// Demands integers.
  void check_integers() const {
    if (!is_integer(type_)) {
      fail(
          fmt::format("the array has elements of type '{}', but these are indices; save "
                      "a.astype('<i8')",
                      header_.type));
    }
  }

  /// Demands integers with a sign.
  void check_signed() const {
    if (!is_signed_integer(type_)) {
      fail(
          fmt::format("the array has elements of type '{}', but these are numbers of periods; save "
                      "a.astype('i1')",
                      header_.type));
    }
  }

  /// Calls `take` with the bytes of each row, one after another. The file's size is checked before
  /// the first; `reserve` is called in between.
  void read_rows(std::uint64_t columns, const std::function<void(std::uint64_t)>& reserve,
                 const std::function<void(const std::byte*)>& take) {
    const std::uint64_t each = columns * size_of(type_);
    row_size_ = each;
    data_begin_ = source_.position();
    if (check_room(source_, rows(), each)) reserve(rows());
    BufferedInput input(source_);
    for (row_ = 0; row_ < rows(); ++row_) {
      const std::byte* const bytes = input.take(each);
      if (bytes == nullptr) {
        fail(fmt::format("the file ends at byte {}, within row {}; get a complete copy",
                         input.end(), row_),
             at_byte(input.end()));
      }
      take(bytes);
    }
  }

  [[nodiscard]] double number(const std::byte* row, std::uint64_t column) const {
    return load_number(type_, row + column * size_of(type_), swap_);
  }

  [[nodiscard]] std::uint64_t index(const std::byte* row, std::uint64_t column) const {
    const std::optional<std::uint64_t> index =
        load_index(type_, row + column * size_of(type_), swap_);
    if (!index) fail_at_row("a number is negative");
    return *index;
  }

  [[noreturn]] void fail(const std::string& what, FilePlace place = {}) const {
    throw BadInput(source_.name(), what, place);
  }

  /// Throws Failure about the row that is being read.
  [[noreturn]] void fail_at_row(const std::string& what) const {
    const std::uint64_t byte = data_begin_ + row_ * row_size_;
    fail(fmt::format("row {} at byte {}: {}", row_, byte, what), at_byte(byte));
  }

 private:
  void choose_type() {
    const std::string_view name = header_.type;
    for (const NamedType& known : kTypes) {
      if (name.size() != 3 || (name[0] != '<' && name[0] != '>') || name.substr(1) != known.name) {
        continue;
      }
      type_ = known.type;
      swap_ = name[0] == '>';
      return;
    }
    fail(
        fmt::format("the array has elements of type '{}', but only f8, f4, i8, u8, i4 and u4 are "
                    "read; save a.astype('<f8') or '<i8'",
                    header_.type));
  }

  InputBytes source_;
  NpyHeader header_;
  NumberType type_ = NumberType::kFloat64;
  bool swap_ = false;
  std::uint64_t row_ = 0;
  std::uint64_t row_size_ = 0;    // in bytes
  std::uint64_t data_begin_ = 0;  // byte of row 0
};

/// Returns the number of coordinates of a vertex.
int read_vertices(FileSystem& files, const std::string& path, Mesh& mesh) {
  ArrayInput array(files, path);
  array.check_shape(2, 6);
  array.check_reals();
  mesh.header.vertices = array.rows();
  const std::uint64_t columns = array.columns();
  mesh.header.attributes = further_coordinates(static_cast<int>(columns));
  const std::size_t further = mesh.header.attributes.record_size();
  array.read_rows(
      columns,
      [&](std::uint64_t rows) {
        mesh.vertices.reserve(rows);
        mesh.attributes.reserve(rows * further);
      },
      [&](const std::byte* row) {
        Point<6> point{};
        for (std::uint64_t axis = 0; axis < columns; ++axis) {
          point[axis] = array.number(row, axis);
          if (!std::isfinite(point[axis])) {
            array.fail_at_row(
                fmt::format("the vertex has the coordinate {}, not finite", point[axis]));
          }
        }
        mesh.vertices.emplace_back(own_coordinates<6>(point));
        const auto beyond = std::as_bytes(further_part<6>(point)).first(further);
        mesh.attributes.insert(mesh.attributes.end(), beyond.begin(), beyond.end());
      });
  return static_cast<int>(columns);
}

void read_simplices(FileSystem& files, const std::string& path, int coordinates, Mesh& mesh) {
  ArrayInput array(files, path);
  array.check_shape(3, 7);
  array.check_integers();
  const std::uint64_t columns = array.columns();
  mesh.header.simplices = array.rows();
  mesh.header.dimension = static_cast<int>(columns) - 1;
  const int needed = std::max(mesh.header.dimension, std::min(coordinates, kOwnAxes));
  if (coordinates != needed) {
    array.fail(
        fmt::format("these are {}, but the vertices have {} coordinates; save them as n x {}",
                    simplices_text(mesh.header.dimension), coordinates, needed));
  }
  array.read_rows(
      columns, [&](std::uint64_t rows) { mesh.corners.reserve(rows * columns); },
      [&](const std::byte* row) {
        for (std::uint64_t c = 0; c < columns; ++c) {
          const std::uint64_t corner = array.index(row, c);
          if (corner >= mesh.header.vertices) {
            array.fail_at_row(fmt::format("the simplex has vertex {}, but there are only {}",
                                          corner, mesh.header.vertices));
          }
          mesh.corners.push_back(corner);
        }
      });
}

void read_input_index(FileSystem& files, const std::string& path, Mesh& mesh) {
  ArrayInput array(files, path);
  array.check_shape(0, 0);
  array.check_integers();
  if (array.rows() != mesh.header.vertices) {
    array.fail(fmt::format("the array has {} elements for {} vertices; it is of another mesh",
                           array.rows(), mesh.header.vertices));
  }
  mesh.header.has_input_index = true;
  array.read_rows(
      1, [&](std::uint64_t rows) { mesh.input_index.reserve(rows); },
      [&](const std::byte* row) { mesh.input_index.push_back(array.index(row, 0)); });
}

/// Low sides, then high sides; open axes have none.
void read_box(FileSystem& files, const std::string& path, Mesh& mesh) {
  ArrayInput array(files, path);
  const int dimension = mesh.header.dimension;
  if (dimension > kOwnAxes) array.fail("only meshes of 2 and 3 dimensions are periodic");
  array.check_exact_shape({2, static_cast<std::uint64_t>(dimension)});
  array.check_reals();
  std::vector<std::array<double, 3>> sides;
  array.read_rows(
      static_cast<std::uint64_t>(dimension), [](std::uint64_t) {},
      [&](const std::byte* row) {
        sides.emplace_back();
        for (int k = 0; k < dimension; ++k) {
          sides.back()[k] = array.number(row, static_cast<std::uint64_t>(k));
        }
      });
  PeriodicBox box{.box = {sides[0], sides[1]}};
  for (int k = 0; k < dimension; ++k) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    box.periodic[k] = box.box.low[k] != -kInfinity || box.box.high[k] != kInfinity;
  }
  box = plain_box(box, dimension);
  const std::string fault = fault_of_box(box, dimension, mesh.header.lattice);
  if (!fault.empty()) array.fail(fault);
  mesh.header.periodic = box;
}

/// After the box.
void read_offsets(FileSystem& files, const std::string& path, Mesh& mesh) {
  ArrayInput array(files, path, true);
  const std::uint64_t corners = mesh.corners_per_simplex();
  const auto axes = static_cast<std::uint64_t>(mesh.header.dimension);
  array.check_exact_shape({mesh.header.simplices, corners, axes});
  array.check_signed();
  array.read_rows(
      corners * axes, [&](std::uint64_t rows) { mesh.offsets.reserve(rows * corners); },
      [&](const std::byte* row) {
        for (std::uint64_t corner = 0; corner < corners; ++corner) {
          ToldPeriods periods{};
          for (std::uint64_t k = 0; k < axes; ++k) {
            periods[k] = array.number(row, corner * axes + k);
          }
          const std::string fault = fault_of_offset(periods, corner, *mesh.header.periodic);
          if (!fault.empty()) array.fail_at_row(fault);
          mesh.offsets.push_back(offset_of(periods));
        }
      });
}

/// Both files, or none of them.
void read_periodic(FileSystem& files, const NpyMeshNames& names, Mesh& mesh) {
  const bool has_offsets = files.exists(names.offsets);
  if (has_offsets != files.exists(names.box)) {
    const std::string& there = has_offsets ? names.offsets : names.box;
    const std::string& missing = has_offsets ? names.box : names.offsets;
    throw BadInput(there, fmt::format("this is of a periodic mesh, to which {} belongs, which is "
                                      "not there; get a complete copy",
                                      missing));
  }
  if (!has_offsets) return;
  read_box(files, names.box, mesh);
  read_offsets(files, names.offsets, mesh);
}

/// Some rows at a time.
void read_attributes(FileSystem& files, const std::string& path, Mesh& mesh) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  InputBytes source(files.open(path));
  const NpyLayout layout = npy_attributes(read_npy_header(source), source.name());
  const std::uint64_t count = mesh.header.vertices;
  if (layout.count != count) {
    throw BadInput(source.name(),
                   fmt::format("the array has {} elements for {} vertices; it is of another mesh",
                               layout.count, count));
  }
  const std::vector<AttributeField>& fields = layout.row.attributes();
  std::vector<Attribute> attributes = mesh.header.attributes.attributes();
  const std::vector<std::byte> coordinates = std::exchange(mesh.attributes, {});
  const std::size_t of_vertex = mesh.header.attributes.record_size();
  for (const AttributeField& field : fields) attributes.push_back(field.attribute);
  mesh.header.attributes = AttributeLayout(std::move(attributes));
  mesh.notices.insert(mesh.notices.end(), layout.notices.begin(), layout.notices.end());
  const std::size_t row = layout.row.size();
  const std::size_t record = mesh.header.attributes.record_size();
  if (record == 0) return;
  if (check_room(source, count, row)) mesh.attributes.reserve(count * record);
  const RecordConversion conversion(fields, mesh.header.attributes.fields());
  std::vector<std::byte> rows(std::max<std::size_t>(kPiece / row, 1) * row);
  for (std::uint64_t read = 0; read < count;) {
    const std::uint64_t some = std::min<std::uint64_t>(rows.size() / row, count - read);
    const std::span<std::byte> piece = std::span(rows).first(some * row);
    if (source.read(piece) < piece.size()) {
      throw BadInput(source.name(),
                     fmt::format("the file ends at byte {}, within its rows; get a complete copy",
                                 source.position()),
                     at_byte(source.position()));
    }
    layout.row.make_native(piece);
    mesh.attributes.resize((read + some) * record);
    if (conversion.convert(piece.data(), row, &mesh.attributes[read * record], record, some)) {
      throw std::logic_error("the layout does not hold the numbers of its source");
    }
    for (std::uint64_t v = read; of_vertex > 0 && v < read + some; ++v) {
      std::copy_n(&coordinates[v * of_vertex], of_vertex, &mesh.attributes[v * record]);
    }
    read += some;
  }
}

}  // namespace

NpyMeshNames npy_mesh_names(const std::string& path) {
  const std::string stem = without(path, kExtension);
  const auto name = [&](std::string_view part) {
    return fmt::format("{}{}{}", stem, part, kExtension);
  };
  return {name(kVertices),   name(kSimplices), name(kInputIndex),
          name(kAttributes), name(kOffsets),   name(kBox)};
}

std::optional<NpyMeshNames> find_npy_mesh(const FileSystem& files, const std::string& path) {
  const std::string stem = without(path, kExtension);
  const NpyMeshNames names = npy_mesh_names(without(without(stem, kVertices), kSimplices));
  if (!files.exists(names.vertices) || !files.exists(names.simplices)) return std::nullopt;
  return names;
}

bool is_part_of_npy_mesh(const FileSystem& files, const std::string& path) {
  std::string stem = without(path, kExtension);
  for (const std::string_view part : {kInputIndex, kAttributes, kOffsets, kBox}) {
    if (!stem.ends_with(part)) continue;
    stem = without(stem, part);
    break;
  }
  const auto names = find_npy_mesh(files, stem);
  return names &&
         (path == names->vertices || path == names->simplices || path == names->input_index ||
          path == names->attributes || path == names->offsets || path == names->box);
}

Mesh read_npy_mesh(FileSystem& files, const NpyMeshNames& names) {
  Mesh mesh;
  const int coordinates = read_vertices(files, names.vertices, mesh);
  read_simplices(files, names.simplices, coordinates, mesh);
  if (files.exists(names.input_index)) read_input_index(files, names.input_index, mesh);
  if (files.exists(names.attributes)) read_attributes(files, names.attributes, mesh);
  read_periodic(files, names, mesh);
  return mesh;
}

}  // namespace spillway::formats
