#include "formats/meshes/stl/stl_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "formats/bytes/buffered_input.h"
#include "formats/bytes/bytes.h"
#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "formats/meshes/common/vertex_joiner.h"
#include "formats/meshes/stl/stl_format.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kProbe = 1024;

/// What a text that begins with kStlOrigin says after that.
Fields fields_of(std::string_view text) {
  text = text.substr(kStlOrigin.size());
  return Fields(text.substr(0, text.find_last_not_of(std::string_view(" \0", 2)) + 1));
}

/// The first three of them, if they are finite numbers.
std::optional<WorldPoint> origin_of(Fields& fields) {
  WorldPoint origin;
  for (double& coordinate : origin) {
    const std::optional<double> number = fields.number();
    if (!number || !std::isfinite(*number)) return std::nullopt;
    coordinate = *number;
  }
  return origin;
}

class BinaryStlReader {
 public:
  explicit BinaryStlReader(InputBytes& source) : size_(source.size()), input_(source) {}

  Mesh read() {
    const std::byte* const header = input_.take(kStlHeader);
    if (header == nullptr) fail_at_end("its header");
    read_text(as_text({header, kStlText}));
    const auto count = load<std::uint32_t>(header + kStlText);
    const std::uint64_t bytes = kStlHeader + std::uint64_t{count} * kStlTriangle;
    if (size_ && bytes > *size_) {
      throw BadInput::at(input_.name(), at_byte(kStlText),
                         fmt::format("the header says {} triangles, which take {} bytes, but the "
                                     "file has {}; get a complete copy",
                                     count, bytes, *size_));
    }
    for (std::uint32_t i = 0; i < count; ++i) read_triangle(i);
    if (input_.take(1) != nullptr) {
      throw BadInput::at(
          input_.name(), at_byte(bytes),
          fmt::format("the file goes on after its {} triangles; its count is wrong", count));
    }
    joiner_.finish();
    return std::move(mesh_);
  }

 private:
  void read_text(std::string_view text) {
    if (!text.starts_with(kStlOrigin)) return;
    Fields fields = fields_of(text);
    const std::optional<WorldPoint> origin = origin_of(fields);
    if (!origin) {
      throw BadInput::at(input_.name(), at_byte(kStlOrigin.size()),
                         "the header's origin must be three numbers");
    }
    origin_ = *origin;
    while (!fields.at_end()) {
      if (!mesh_.header.crs.empty()) mesh_.header.crs += ' ';
      mesh_.header.crs += fields.word();
    }
  }

  void read_triangle(std::uint32_t number) {
    const std::byte* const record = input_.take(kStlTriangle);
    if (record == nullptr) fail_at_end(fmt::format("triangle {}", number));
    for (int k = 0; k < 3; ++k) {
      const auto local = load<std::array<float, 3>>(record + (k + 1) * sizeof(float) * 3);
      WorldPoint corner;
      for (int axis = 0; axis < 3; ++axis) {
        corner[axis] = origin_[axis] + local[axis];
        if (!std::isfinite(corner[axis])) {
          throw BadInput(
              input_.name(),
              fmt::format("before byte {}: triangle {} is not finite", input_.position(), number),
              at_byte(input_.position()));
        }
      }
      joiner_.add(corner);
    }
  }

  [[noreturn]] void fail_at_end(const std::string& where) const {
    throw BadInput(input_.name(),
                   fmt::format("the file ends at byte {}, within {}; get a complete copy",
                               input_.end(), where),
                   at_byte(input_.end()));
  }

  std::optional<std::uint64_t> size_;
  BufferedInput input_;
  Mesh mesh_;
  VertexJoiner joiner_{mesh_};
  WorldPoint origin_{};
};

/// The grammar: "solid NAME", then per triangle "facet normal X Y Z", "outer loop", three times
/// "vertex X Y Z", "endloop", "endfacet"; then "endsolid NAME". Several solids make one mesh.
class AsciiStlReader {
 public:
  explicit AsciiStlReader(InputBytes& source) : source_(source), lines_(source) {}

  Mesh read() {
    bool within_solid = false;
    std::string_view word;
    while (next(word)) {
      if (!within_solid && word == "solid") {
        within_solid = true;
      } else if (within_solid && word == "endsolid") {
        within_solid = false;
      } else if (within_solid && word == "facet") {
        read_facet();
      } else {
        fail(fmt::format("found {} instead of {}", quoted(word),
                         within_solid ? "a facet or endsolid" : "solid"));
      }
    }
    if (within_solid) fail("the file ends before endsolid; get a complete copy");
    joiner_.finish();
    return std::move(mesh_);
  }

 private:
  void read_facet() {
    expect("outer");
    for (int k = 0; k < 3; ++k) {
      expect("vertex");
      WorldPoint corner;
      for (double& coordinate : corner) {
        const std::optional<double> number = fields_.number();
        if (!number || !std::isfinite(*number)) fail("a vertex needs three finite numbers");
        coordinate = *number;
      }
      joiner_.add(corner);
    }
    expect("endloop");
    expect("endfacet");
  }

  /// Goes to the next line that is not blank, and to its first word; false at the end.
  bool next(std::string_view& word) {
    std::string_view line;
    while (lines_.next(line)) {
      fields_ = Fields(line);
      word = fields_.word();
      if (!word.empty()) return true;
      lines_.pass_over();
    }
    return false;
  }

  void expect(std::string_view wanted) {
    std::string_view word;
    if (!next(word)) fail(fmt::format("the file ends before {}; get a complete copy", wanted));
    if (word != wanted) fail(fmt::format("found {} instead of {}", quoted(word), wanted));
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput::at(source_.name(), at_line(lines_.number()), what);
  }

  InputBytes& source_;
  LineReader lines_;
  Fields fields_{""};
  Mesh mesh_;
  VertexJoiner joiner_{mesh_};
};

}  // namespace

bool looks_like_ascii_stl(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  if (!text.starts_with("solid")) return false;
  // Binary files may begin with this word, too.
  return text.find("facet") != text.npos || text.find("endsolid") != text.npos;
}

std::optional<WorldPoint> stl_origin(InputBytes& source) {
  const std::string_view text = as_text(source.peek(kStlText)).substr(0, kStlText);
  if (!text.starts_with(kStlOrigin)) return std::nullopt;
  Fields fields = fields_of(text);
  return origin_of(fields);
}

Mesh read_stl(InputBytes& source) {
  const std::string_view text = as_text(source.peek(kProbe));
  if (looks_like_ascii_stl(text)) return AsciiStlReader(source).read();
  // The count and the floats of a binary file are no text.
  if (text.size() == kProbe && looks_like_text(text)) {
    throw BadInput(source.name(), "this is text, but not STL; name its format");
  }
  return BinaryStlReader(source).read();
}

}  // namespace spillway::formats
