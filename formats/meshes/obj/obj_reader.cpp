#include "formats/meshes/obj/obj_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "formats/bytes/notes.h"
#include "formats/meshes/common/face_cutter.h"
#include "formats/meshes/common/mesh_checks.h"
#include "formats/meshes/common/mesh_notes.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

class ObjReader {
 public:
  explicit ObjReader(InputBytes& source) : file_(source.name()), lines_(source) {}

  Mesh read() {
    std::string_view line;
    while (lines_.next(line)) {
      if (line.starts_with("# ")) {
        read_comment(line.substr(2));
        lines_.pass_over();
      } else {
        read_statement(line.substr(0, line.find('#')));
      }
    }
    if (faces_ == 0 && !by_spillway_) fail_for_point_cloud(file_, "OBJ");
    if (faces_ > 0 && largest_ >= mesh_.vertices.size()) {
      throw BadInput::at(file_, at_line(largest_line_),
                         fmt::format("a face has vertex {}, but there are only {}", largest_ + 1,
                                     mesh_.vertices.size()));
    }
    mesh_.header.vertices = mesh_.vertices.size();
    cutter_.finish();
    return std::move(mesh_);
  }

 private:
  void read_comment(std::string_view comment) {
    if (!read_mesh_note(comment, mesh_.header)) {
      fail("the lattice must be six numbers: three positive scales, three offsets");
    }
    by_spillway_ |= is_spillway_note(comment);
  }

  /// Statements other than of vertices and faces are passed over: those of texture and normals by
  /// the million, others as long as they come to an end.
  void read_statement(std::string_view statement) {
    Fields fields(statement);
    const std::string_view keyword = fields.word();
    if (keyword == "v") {
      read_vertex(fields);
    } else if (keyword == "f") {
      read_face(fields);
    } else if (keyword != "vt" && keyword != "vn") {
      lines_.pass_over();
    }
  }

  /// What follows x, y, z is a weight or a colour.
  void read_vertex(Fields& fields) {
    WorldPoint point;
    for (double& coordinate : point) {
      const std::optional<double> number = fields.number();
      if (!number || !std::isfinite(*number)) {
        fail(fmt::format("vertex {} needs three finite coordinates", mesh_.vertices.size() + 1));
      }
      coordinate = *number;
    }
    mesh_.vertices.push_back(point);
  }

  void read_face(Fields& fields) {
    const FaceName face{++faces_, at_line(lines_.number())};
    face_.clear();
    while (!fields.at_end()) {
      const std::uint64_t corner = corner_of(fields.word());
      face_.push_back(corner);
      if (corner >= largest_) {
        largest_ = corner;
        largest_line_ = lines_.number();
      }
    }
    cutter_.add(face_, face);
  }

  /// The vertex of `a`, `a/b`, `a/b/c` or `a//c`, counted from 0. A negative number counts back
  /// from the last vertex so far.
  [[nodiscard]] std::uint64_t corner_of(std::string_view text) const {
    Fields vertex(text.substr(0, text.find('/')));
    const std::optional<std::int64_t> number = vertex.integer();
    const auto vertices = static_cast<std::int64_t>(mesh_.vertices.size());
    if (!number || *number == 0 || *number < -vertices) {
      fail(fmt::format("{} is not a vertex of a face", quoted(text)));
    }
    return static_cast<std::uint64_t>(*number > 0 ? *number - 1 : vertices + *number);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput::at(file_, at_line(lines_.number()), what);
  }

  std::string file_;
  LineReader lines_;
  Mesh mesh_;
  FaceCutter cutter_{file_, mesh_};
  std::vector<std::uint64_t> face_;  // corners of the face being read
  std::uint64_t faces_ = 0;
  bool by_spillway_ = false;
  std::uint64_t largest_ = 0;  // largest corner, checked when all vertices are known
  std::uint64_t largest_line_ = 0;
};

}  // namespace

Mesh read_obj(InputBytes& source) { return ObjReader(source).read(); }

}  // namespace spillway::formats
