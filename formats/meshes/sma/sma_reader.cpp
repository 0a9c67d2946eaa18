#include "formats/meshes/sma/sma_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "formats/bytes/fields.h"
#include "formats/bytes/line_reader.h"
#include "formats/meshes/common/import_check.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_checks.h"
#include "formats/meshes/common/mesh_notes.h"
#include "src/error.h"
#include "src/geometry/lattice_check.h"

namespace spillway::formats {
namespace {

// A block ends when it has as many as this of anything.
constexpr std::size_t kBlockSize = 16384;

// Marks the number of an imported vertex until it is known how many new ones there are.
constexpr std::uint32_t kImportedMark = std::uint32_t{1} << 31;

/// The number that the lattice maps to `world`. If there is none, which is possible for a z that
/// another program has changed, the one that is mapped closest, to a rounding error.
double nearest_on_lattice(const IntegerLattice& lattice, int axis, double world) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double guess = (world - lattice.offset[axis]) / lattice.scale[axis];
  double below = guess;
  double above = guess;
  for (int step = 0; step < 4; ++step) {
    if (lattice.to_world(axis, below) == world) return below;
    if (lattice.to_world(axis, above) == world) return above;
    below = std::nextafter(below, -kInfinity);
    above = std::nextafter(above, kInfinity);
  }
  return guess;
}

class SmaReader : public MeshStreamReader {
 public:
  explicit SmaReader(std::unique_ptr<InputBytes> source)
      : source_(std::move(source)), lines_(*source_) {
    MeshFileHeader notes;
    while ((has_line_ = lines_.next(line_)) && !is_element(line_)) {
      read_header_line(notes);
      lines_.pass_over();
    }
    header_.lattice = notes.lattice;
    header_.crs = notes.crs;
    if (!extent_.empty() && extent_.contains(extent_.hi)) header_.extent = extent_;
  }

  [[nodiscard]] const MeshStreamHeader& header() const override { return header_; }

  bool read(MeshStreamBlock& block) override {
    block.clear();
    first_ = totals_.vertices;
    gone_.clear();
    imported_.clear();
    for (; has_line_; has_line_ = lines_.next(line_)) {
      if (is_full(block)) break;
      read_line(block);
    }
    if (block.vertices.empty() && block.corners.empty() && block.finalized.empty()) {
      check_end();
      return false;
    }
    close(block);
    if (header_.lattice) {
      check_lattice({source_->name()}, *header_.lattice, box_around(block.vertices),
                    header_.dimension);
    }
    return true;
  }

  [[nodiscard]] const MeshTotals& totals() const override { return totals_; }
  [[nodiscard]] bool has_hash() const override { return false; }
  [[nodiscard]] std::optional<double> fraction_read() const override {
    return source_->fraction_read();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw BadInput::at(source_->name(), at_line(lines_.number()), what);
  }

  static bool is_element(std::string_view line) {
    Fields fields(line);
    const std::string_view keyword = fields.word();
    return keyword == "v" || keyword == "f" || keyword == "x";
  }

  static bool is_full(const MeshStreamBlock& block) {
    return block.vertices.size() >= kBlockSize || block.corners.size() >= 3 * kBlockSize ||
           block.finalized.size() >= 2 * kBlockSize;
  }

  /// The text of a comment; nothing if the line is none.
  static std::optional<std::string_view> comment_of(std::string_view line) {
    if (!line.starts_with('#')) return std::nullopt;
    line.remove_prefix(line.starts_with("# ") ? 2 : 1);
    return line;
  }

  void read_header_line(MeshFileHeader& notes) {
    const std::optional<std::string_view> comment = comment_of(line_);
    if (!comment) return check_blank();
    if (!read_mesh_note(*comment, notes)) {
      fail("the lattice must be six numbers: three positive scales, three offsets");
    }
    by_spillway_ |= line_ == kSmaNote;
    read_counts(*comment);
    Fields fields(*comment);
    const std::string_view keyword = fields.word();
    if (keyword != "bb_min" && keyword != "bb_max") return;
    for (double& bound : keyword == "bb_min" ? extent_.lo : extent_.hi) {
      bound = fields.number().value_or(std::numeric_limits<double>::quiet_NaN());
      if (!std::isfinite(bound)) fail("a corner of the bounding box is three finite numbers");
    }
  }

  void read_counts(std::string_view comment) {
    Fields fields(comment);
    const std::string_view keyword = fields.word();
    if (keyword == "nverts") expected_vertices_ = fields.count();
    if (keyword == "nfaces") expected_triangles_ = fields.count();
  }

  void check_blank() const {
    if (!Fields(line_).at_end()) {
      fail(fmt::format("{} is not a line of a streaming mesh", quoted(line_)));
    }
  }

  void read_line(MeshStreamBlock& block) {
    Fields fields(line_);
    const std::string_view keyword = fields.word();
    if (keyword == "v") {
      read_vertex(fields, block);
    } else if (keyword == "f") {
      read_triangle(fields, block);
    } else if (keyword == "x") {
      block.finalized.push_back(use(read_number(fields), true, block));
    } else if (const std::optional<std::string_view> comment = comment_of(line_)) {
      read_counts(*comment);
      lines_.pass_over();
    } else {
      check_blank();
      lines_.pass_over();
    }
  }

  void read_vertex(Fields& fields, MeshStreamBlock& block) {
    WorldPoint vertex;
    for (double& coordinate : vertex) {
      const std::optional<double> number = fields.number();
      if (!number || !std::isfinite(*number)) {
        fail(fmt::format("vertex {} needs three finite coordinates", totals_.vertices + 1));
      }
      coordinate = *number;
    }
    block.vertices.push_back(header_.lattice ? on_lattice(vertex) : LatticePoint(vertex.numbers()));
    gone_.push_back(false);
    ++totals_.vertices;
  }

  [[nodiscard]] LatticePoint on_lattice(const WorldPoint& vertex) const {
    LatticePoint point;
    for (int axis = 0; axis < 3; ++axis) {
      const double world = vertex[axis];
      const std::optional<double> integer = header_.lattice->to_integer(axis, world);
      if (!integer && axis < 2) {
        fail(
            fmt::format("coordinate {} is not on the lattice in the file's comment; remove "
                        "the comment",
                        world));
      }
      point[axis] = integer ? *integer : nearest_on_lattice(*header_.lattice, axis, world);
    }
    return point;
  }

  void read_triangle(Fields& fields, MeshStreamBlock& block) {
    std::array<std::int64_t, 3> numbers;
    for (std::int64_t& number : numbers) number = read_number(fields);
    if (!fields.at_end()) fail("a face has more than three corners; only triangles are read");
    for (const std::int64_t number : numbers) {
      const std::uint32_t corner = use(number, false, block);
      block.corners.push_back(corner);
    }
    // A vertex ends with the triangle, not within it.
    for (const std::int64_t number : numbers) {
      if (number < 0) block.finalized.push_back(use(number, true, block));
    }
    ++totals_.simplices;
  }

  [[nodiscard]] std::int64_t read_number(Fields& fields) const {
    const std::optional<std::int64_t> number = fields.integer();
    if (!number || *number == 0) fail("the number of a vertex is missing, or is not a number");
    return *number;
  }

  /// The short number, or the marked place among the imported ones, of the vertex with this number:
  /// from 1, or negative and counted back from the newest one.
  std::uint32_t use(std::int64_t number, bool ends, MeshStreamBlock& block) {
    const auto vertices = static_cast<std::int64_t>(totals_.vertices);
    if (number > vertices || number < -vertices) {
      fail(
          fmt::format("vertex {} is used, but only {} came before; only streams with vertices "
                      "before their triangles are read",
                      number, vertices));
    }
    const auto vertex = static_cast<std::uint64_t>(number > 0 ? number - 1 : vertices + number);
    if (vertex >= first_) {
      const auto place = static_cast<std::uint32_t>(vertex - first_);
      if (gone_[place]) fail_for_gone(vertex);
      gone_[place] = ends;
      return place;
    }
    const auto [entry, is_new] = imported_.try_emplace(vertex);
    if (is_new) {
      if (!imports_.import(vertex)) fail_for_gone(vertex);
      entry->second.place = static_cast<std::uint32_t>(block.imported.size());
      block.imported.push_back(vertex);
    }
    if (entry->second.gone) fail_for_gone(vertex);
    entry->second.gone = ends;
    return kImportedMark | entry->second.place;
  }

  [[noreturn]] void fail_for_gone(std::uint64_t vertex) const {
    fail(fmt::format("vertex {} is used after its end", vertex + 1));
  }

  /// Gives the imported vertices their short numbers and notes which vertices live on.
  void close(MeshStreamBlock& block) {
    const auto vertices = static_cast<std::uint32_t>(block.vertices.size());
    for (std::vector<std::uint32_t>* const numbers : {&block.corners, &block.finalized}) {
      for (std::uint32_t& number : *numbers) {
        if ((number & kImportedMark) != 0) number = vertices + (number & ~kImportedMark);
      }
    }
    imports_.settle(block);
  }

  void check_end() const {
    const auto check = [this](std::uint64_t came, const std::optional<std::uint64_t>& expected,
                              const char* what) {
      if (expected ? came == *expected : !by_spillway_) return;
      throw BadInput(
          source_->name(),
          fmt::format("the mesh is cut short: {} {} came{}; get a complete copy or make it again",
                      came, what,
                      expected ? fmt::format(", but there should be {}", *expected)
                               : ", and no line says how many there should be"),
          at_line(lines_.number()));
    };
    check(totals_.vertices, expected_vertices_, "vertices");
    check(totals_.simplices, expected_triangles_, "triangles");
    if (totals_.simplices == 0 && !expected_triangles_)
      fail_for_point_cloud(source_->name(), "sma");
  }

  struct Imported {
    std::uint32_t place = 0;  // in MeshStreamBlock::imported
    bool gone = false;
  };

  std::unique_ptr<InputBytes> source_;
  LineReader lines_;
  std::string_view line_;  // read but not yet dealt with, if has_line_
  bool has_line_ = false;
  MeshStreamHeader header_;
  Box<3> extent_;
  bool by_spillway_ = false;
  std::optional<std::uint64_t> expected_vertices_;
  std::optional<std::uint64_t> expected_triangles_;
  MeshTotals totals_;  // so far
  ImportCheck imports_;

  // Of the block in work:
  std::uint64_t first_ = 0;  // number of its first vertex
  std::vector<bool> gone_;   // by new vertex
  std::unordered_map<std::uint64_t, Imported> imported_;
};

}  // namespace

bool looks_like_sma(std::string_view text) {
  if (text.starts_with(kSmaNote)) return true;
  while (text.starts_with('#') || text.starts_with('\n') || text.starts_with('\r')) {
    const std::size_t end = text.find('\n');
    if (end == text.npos) return false;
    text.remove_prefix(end + 1);
  }
  return text.starts_with("v ") || text.starts_with("v\t");
}

std::unique_ptr<MeshStreamReader> open_sma_reader(std::unique_ptr<InputBytes> source) {
  return std::make_unique<SmaReader>(std::move(source));
}

}  // namespace spillway::formats
