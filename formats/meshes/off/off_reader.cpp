#include "formats/meshes/off/off_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "formats/bytes/notes.h"
#include "formats/meshes/common/face_cutter.h"
#include "formats/meshes/common/mesh_checks.h"
#include "formats/meshes/common/mesh_notes.h"
#include "formats/meshes/off/off_kind.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

// "0 0 0" and "3 0 1 2", each with the end of its line.
constexpr std::uint64_t kSmallestVertex = 6;
constexpr std::uint64_t kSmallestFace = 8;

class OffReader {
 public:
  explicit OffReader(InputBytes& source) : source_(source), lines_(source) {}

  Mesh read() {
    read_kind();
    read_counts();
    for (std::uint64_t i = 0; i < mesh_.header.vertices; ++i) read_vertex(i);
    for (std::uint64_t i = 0; i < faces_; ++i) read_face(i);
    if (next_line()) fail("the file goes on after its last face; its counts are wrong");
    if (faces_ == 0 && !by_spillway_) fail_for_point_cloud(source_.name(), "OFF");
    cutter_.finish();
    return std::move(mesh_);
  }

 private:
  void read_kind() {
    if (next_line()) kind_name_ = fields_.word();
    const std::optional<OffKind> kind = off_kind(kind_name_);
    if (!kind) {
      fail(
          "this is not an OFF file: its first line is not \"OFF\" (nor COFF, NOFF, ...); name its "
          "format");
    }
    if (kind->is_homogeneous || kind->has_dimension) {
      fail(
          fmt::format("{} has vertices of more or fewer coordinates than three, which are not "
                      "read; save the mesh as OFF",
                      kind_name_));
    }
    if (Fields(fields_).word() == "BINARY") {
      fail(fmt::format("{} BINARY is not read; save the mesh as text", kind_name_));
    }
    kind_ = *kind;
  }

  /// The counts of vertices, faces and (not needed) edges, on the first line or the next.
  void read_counts() {
    if (fields_.at_end() && !next_line()) fail_at_end("the counts");
    const std::optional<std::uint64_t> vertices = fields_.count();
    const std::optional<std::uint64_t> faces = fields_.count();
    if (!vertices || !faces) fail("the numbers of vertices and faces are missing");
    mesh_.header.vertices = *vertices;
    faces_ = *faces;
    const std::optional<std::uint64_t> size = source_.size();
    if (!size) return;
    // The end of the last line may be missing.
    if (*vertices > (*size + 1) / kSmallestVertex || *faces > (*size + 1) / kSmallestFace) {
      fail(
          fmt::format("the file says {} vertices and {} faces, but ends at byte {}, so has fewer; "
                      "get a complete copy",
                      *vertices, *faces, *size));
    }
    mesh_.vertices.reserve(*vertices);
    mesh_.corners.reserve(*faces * 3);
  }

  void read_vertex(std::uint64_t number) {
    if (!next_line()) fail_at_end(fmt::format("vertex {}", number));
    WorldPoint point;
    for (double& coordinate : point) {
      const std::optional<double> value = fields_.number();
      if (!value || !std::isfinite(*value)) {
        fail(fmt::format("vertex {} needs three finite coordinates", number));
      }
      coordinate = *value;
    }
    pass_over_extras(number);
    mesh_.vertices.push_back(point);
  }

  /// Normals, colours and places in textures.
  void pass_over_extras(std::uint64_t vertex) {
    int extras = 0;
    for (; !fields_.at_end(); ++extras) {
      const std::string_view word = fields_.word();
      if (!Fields(word).number())
        fail(fmt::format("{} of vertex {} is no number", quoted(word), vertex));
    }
    const int fewest = kind_.fewest_extras();
    const int most = kind_.most_extras();
    if (extras >= fewest && extras <= most) return;
    fail(fmt::format(
        "vertex {} has {} numbers instead of {}{}, which it has where a file begins with {}",
        vertex, extras + 3, fewest + 3, most > fewest ? fmt::format(" or {}", most + 3) : "",
        kind_name_));
  }

  /// What follows the corners is a colour.
  void read_face(std::uint64_t number) {
    if (!next_line()) fail_at_end(fmt::format("face {}", number));
    const std::optional<std::uint64_t> length = fields_.count();
    if (!length) fail(fmt::format("face {} needs the number of its corners", number));
    const FaceName face{number, at_line(lines_.number())};
    cutter_.check_length(*length, face);
    face_.clear();
    while (face_.size() < *length) {
      const std::optional<std::uint64_t> corner = fields_.count();
      if (!corner) fail(fmt::format("face {} needs {} vertex numbers", number, *length));
      if (*corner >= mesh_.header.vertices) {
        fail(fmt::format("face {} has vertex {}, but there are only {}", number, *corner,
                         mesh_.header.vertices));
      }
      face_.push_back(*corner);
    }
    cutter_.add(face_, face);
  }

  /// Goes to the next line that has more than a comment; takes notes from comments.
  bool next_line() {
    std::string_view line;
    while (lines_.next(line)) {
      if (line.starts_with("# ")) {
        const std::string_view comment = line.substr(2);
        if (!read_mesh_note(comment, mesh_.header)) {
          fail("the lattice must be six numbers: three positive scales, three offsets");
        }
        by_spillway_ |= is_spillway_note(comment);
      }
      fields_ = Fields(line.substr(0, line.find('#')));
      if (!fields_.at_end()) return true;
      lines_.pass_over();
    }
    return false;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput::at(source_.name(), at_line(lines_.number()), what);
  }

  [[noreturn]] void fail_at_end(const std::string& what) const {
    throw BadInput(source_.name(),
                   fmt::format("the file ends with line {}, before {}; get a complete copy",
                               lines_.number(), what),
                   at_line(lines_.number()));
  }

  InputBytes& source_;
  LineReader lines_;
  Fields fields_{""};
  std::string kind_name_;
  OffKind kind_;
  Mesh mesh_;
  FaceCutter cutter_{source_.name(), mesh_};
  std::vector<std::uint64_t> face_;  // corners of the face being read
  std::uint64_t faces_ = 0;
  bool by_spillway_ = false;
};

}  // namespace

Mesh read_off(InputBytes& source) { return OffReader(source).read(); }

}  // namespace spillway::formats
