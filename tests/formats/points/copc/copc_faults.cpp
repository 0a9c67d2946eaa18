#include "tests/formats/points/copc/copc_faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "formats/bytes/input_bytes.h"
#include "formats/points/laz/chunk_table.h"
#include "src/error.h"
#include "tests/formats/point_test_helpers.h"

namespace spillway::test {
namespace {

constexpr std::size_t kHeader = 375;
constexpr std::size_t kInfo = kHeader + 54;
constexpr std::size_t kInfoSize = 160;
constexpr std::size_t kEntry = 32;

using Key = std::array<std::int32_t, 4>;  // level, x, y, z

struct Record {
  std::string user;
  std::uint16_t id = 0;
  std::size_t content = 0;  // byte of the file
  std::uint64_t size = 0;
};

struct Node {
  Key key{};
  std::uint64_t offset = 0;
  std::int32_t bytes = 0;
  std::int32_t count = 0;
};

/// What points have of what the header and the first record sum up.
struct Point {
  std::array<double, 3> world{};
  unsigned return_number = 0;
  double time = 0;
};

class Validation {
 public:
  explicit Validation(const std::string& file) : file_(file) {}

  std::vector<std::string> run() && {
    if (check_header() && check_records() && check_pages()) {
      check_nodes();
      check_chunk_table();
      check_points();
    }
    return std::move(faults_);
  }

 private:
  template <typename T>
  [[nodiscard]] T at(std::size_t byte) const {
    T value{};
    if (byte + sizeof(T) <= file_.size()) std::memcpy(&value, &file_[byte], sizeof(T));
    return value;
  }

  bool require(bool holds, const std::string& rule) {
    if (!holds && std::ranges::find(faults_, rule) == faults_.end()) faults_.push_back(rule);
    return holds;
  }

  [[nodiscard]] int point_format() const { return at<std::uint8_t>(104) & 0x3F; }
  [[nodiscard]] std::uint64_t count() const { return at<std::uint64_t>(247); }
  [[nodiscard]] std::uint64_t points_at() const { return at<std::uint32_t>(96); }

  bool check_header() {
    if (!require(file_.size() >= kInfo + kInfoSize && file_.starts_with("LASF"),
                 "the file begins as LAS")) {
      return false;
    }
    require(at<std::uint8_t>(24) == 1 && at<std::uint8_t>(25) == 4, "the version is 1.4");
    require(at<std::uint16_t>(94) == kHeader, "the header has 375 bytes");
    require(point_format() >= 6 && point_format() <= 8, "the point format is 6, 7 or 8");
    require((at<std::uint8_t>(104) & 0x80) != 0, "the points are compressed");
    require((at<std::uint16_t>(6) & 0x10) != 0, "the coordinate system is WKT");
    require(std::ranges::all_of(file_.substr(107, 24), [](char c) { return c == 0; }),
            "the legacy counts are 0");
    return true;
  }

  /// The records before or behind the points.
  std::optional<std::vector<Record>> records(std::size_t byte, std::uint32_t number,
                                             bool extended) const {
    std::vector<Record> all;
    for (std::uint32_t i = 0; i < number; ++i) {
      const std::size_t header = extended ? 60 : 54;
      if (byte + header > file_.size()) return std::nullopt;
      Record record{.user = std::string(file_.substr(byte + 2, 16).c_str()),
                    .id = at<std::uint16_t>(byte + 18),
                    .content = byte + header,
                    .size = extended ? at<std::uint64_t>(byte + 20) : at<std::uint16_t>(byte + 20)};
      if (record.size > file_.size() - record.content) return std::nullopt;
      byte = record.content + record.size;
      all.push_back(record);
    }
    return all;
  }

  bool check_records() {
    const auto before = records(kHeader, at<std::uint32_t>(100), false);
    const auto behind = records(at<std::uint64_t>(235), at<std::uint32_t>(243), true);
    if (!require(before && behind, "records lie within the file")) return false;
    if (!require(!before->empty() && before->front().user == "copc" && before->front().id == 1 &&
                     before->front().size == kInfoSize,
                 "the info record of 160 bytes is the first")) {
      return false;
    }
    require(before->back().content + before->back().size == points_at(),
            "points follow the last record");
    require(std::ranges::all_of(file_.substr(kInfo + 72, 88), [](char c) { return c == 0; }),
            "reserved numbers are 0");
    bool has_laz = false;
    for (const Record& record : *before) {
      require(record.user != "LASF_Projection" || record.id == 2112 || record.id == 2111,
              "no keys tell the coordinate system");
      if (record.user != "laszip encoded" || record.id != 22204) continue;
      has_laz = true;
      require(at<std::uint16_t>(record.content) == 3, "chunks are layered");
      require(at<std::uint32_t>(record.content + 12) == 0xFFFFFFFF, "chunks are of variable size");
    }
    require(has_laz, "a record tells of the compression");
    for (const Record& record : *behind) {
      if (record.user == "copc" && record.id == 1000) hierarchy_ = record;
    }
    return require(hierarchy_.size > 0, "there is a hierarchy record");
  }

  bool check_pages() {
    for (std::size_t axis = 0; axis < 3; ++axis) centre_[axis] = at<double>(kInfo + 8 * axis);
    halfsize_ = at<double>(kInfo + 24);
    if (!require(std::isfinite(halfsize_) && halfsize_ > 0, "the cube has a size")) return false;
    const auto spacing = at<double>(kInfo + 32);
    require(std::isfinite(spacing) && spacing > 0 && spacing <= 2 * halfsize_,
            "the spacing is a part of the cube");
    struct Page {
      std::uint64_t offset;
      std::uint64_t size;
      Key top;
    };
    std::vector<Page> pages = {
        {at<std::uint64_t>(kInfo + 40), at<std::uint64_t>(kInfo + 48), Key{}}};
    std::set<std::uint64_t> seen;
    for (std::size_t p = 0; p < pages.size(); ++p) {
      const Page page = pages[p];
      const bool within = page.offset >= hierarchy_.content && page.size > 0 &&
                          page.size % kEntry == 0 && page.size <= hierarchy_.size &&
                          page.offset - hierarchy_.content <= hierarchy_.size - page.size;
      if (!require(within, "pages are entries within the hierarchy record")) return false;
      if (!require(seen.insert(page.offset).second, "each page is referred to once")) return false;
      bool has_top = false;
      for (std::uint64_t i = page.offset; i < page.offset + page.size; i += kEntry) {
        const Node node{at<Key>(i), at<std::uint64_t>(i + 16), at<std::int32_t>(i + 24),
                        at<std::int32_t>(i + 28)};
        has_top = has_top || (node.key == page.top && node.count >= 0);
        if (node.count == -1) {
          pages.push_back({node.offset, static_cast<std::uint64_t>(node.bytes), node.key});
          continue;
        }
        require(nodes_.emplace(node.key, node).second, "each node has one entry");
      }
      require(has_top, "a page tells of the node that it is of");
    }
    return true;
  }

  void check_nodes() {
    std::uint64_t points = 0;
    for (const auto& [key, node] : nodes_) {
      const std::int32_t level = key[0];
      const bool exists = level >= 0 && level < 31 &&
                          std::all_of(key.begin() + 1, key.end(), [&](std::int32_t cell) {
                            return cell >= 0 && cell < std::int64_t{1} << level;
                          });
      require(exists, "keys are of the octree");
      require(level == 0 || nodes_.contains(parent_of(key)), "each node has its parent");
      require(node.count >= 0, "counts are not negative");
      if (node.count == 0) {
        require(node.offset == 0 && node.bytes == 0, "empty nodes have no chunk");
        continue;
      }
      points += static_cast<std::uint64_t>(node.count);
      in_file_order_.push_back(node);
    }
    require(points == count(), "nodes have all points");
    std::ranges::sort(in_file_order_, {}, &Node::offset);
    std::uint64_t next = points_at() + 8;
    for (const Node& node : in_file_order_) {
      require(node.offset == next, "chunks lie one behind the other");
      next = node.offset + static_cast<std::uint64_t>(node.bytes);
    }
    require(at<std::uint64_t>(points_at()) == next, "the chunk table follows the chunks");
  }

  static Key parent_of(const Key& key) { return {key[0] - 1, key[1] / 2, key[2] / 2, key[3] / 2}; }

  void check_chunk_table() {
    bool same = false;
    try {
      FaultyFileSystem files;
      files.files["a"] = file_;
      InputBytes source(files.open("a"));
      const LasHeader header = read_las_header(source);
      const auto table = read_chunk_table(source, header);
      same =
          table && table->more == 0 &&
          std::ranges::equal(table->chunks, in_file_order_, [](const auto& chunk, const Node& n) {
            return chunk.offset == n.offset && chunk.bytes == static_cast<unsigned>(n.bytes) &&
                   chunk.count == static_cast<unsigned>(n.count);
          });
    } catch (const Failure&) {
    }
    require(same, "the chunk table lists the nodes");
  }

  std::vector<Point> points() const {
    FaultyFileSystem files;
    files.files["a.laz"] = file_;
    PointReaderOptions options;
    options.keep_withheld = true;
    const auto reader = open_point_reader(files, "a.laz", options);
    const AttributeLayout layout = reader->header().attributes;
    reader->carry(layout);
    std::vector<Point> all;
    PointBlock block;
    while (reader->read(block)) {
      for (std::size_t i = 0; i < block.size(); ++i) {
        const std::byte* const record = &block.attributes[i * layout.record_size()];
        Point point;
        const WorldPoint world = reader->header().lattice->to_world(block.points[i]);
        for (int axis = 0; axis < 3; ++axis) point.world[axis] = world[axis];
        point.return_number = std::to_integer<unsigned>(record[layout.find("return_number")->at]);
        std::memcpy(&point.time, record + layout.find("gps_time")->at, sizeof(double));
        all.push_back(point);
      }
    }
    return all;
  }

  void check_points() {
    std::vector<Point> all;
    try {
      all = points();
    } catch (const Failure&) {
    }
    if (!require(all.size() == count(), "the header counts the points")) return;
    std::array<std::uint64_t, 16> returns{};
    std::array<double, 3> least{}, most{};
    double first = 0, last = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Point& point = all[i];
      ++returns[point.return_number];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        least[axis] = i == 0 ? point.world[axis] : std::min(least[axis], point.world[axis]);
        most[axis] = i == 0 ? point.world[axis] : std::max(most[axis], point.world[axis]);
      }
      first = i == 0 ? point.time : std::min(first, point.time);
      last = i == 0 ? point.time : std::max(last, point.time);
    }
    for (std::size_t i = 1; i < returns.size(); ++i) {
      require(at<std::uint64_t>(247 + 8 * i) == returns[i], "the header counts the returns");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (all.empty()) break;
      require(
          at<double>(179 + 16 * axis) == most[axis] && at<double>(187 + 16 * axis) == least[axis],
          "the header has the bounds of the points");
      require(centre_[axis] - halfsize_ <= least[axis] && most[axis] <= centre_[axis] + halfsize_,
              "the cube has all points");
    }
    require(at<double>(kInfo + 56) == first && at<double>(kInfo + 64) == last,
            "the info record has the first and the last time");
    check_places(all);
  }

  void check_places(const std::vector<Point>& all) {
    std::size_t next = 0;
    for (const Node& node : in_file_order_) {
      const double side = std::ldexp(2 * halfsize_, -node.key[0]);
      for (std::int32_t i = 0; i < node.count && next < all.size(); ++i, ++next) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double low = centre_[axis] - halfsize_ + node.key[axis + 1] * side;
          const double value = all[next].world[axis];
          require(value >= low && value <= low + side, "points lie in the cube of their node");
        }
      }
    }
  }

  const std::string& file_;
  std::vector<std::string> faults_;
  Record hierarchy_;
  std::array<double, 3> centre_{};
  double halfsize_ = 0;
  std::map<Key, Node> nodes_;
  std::vector<Node> in_file_order_;  // those with points
};

}  // namespace

std::vector<std::string> copc_faults(const std::string& file) { return Validation(file).run(); }

}  // namespace spillway::test
