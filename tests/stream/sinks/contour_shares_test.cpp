// Contours that several processes draw, each of a part of the mesh, are those of one.

#include "stream/sinks/contour_shares.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "formats/disk/scratch_folder.h"

namespace spillway::test {
namespace {

using Line = std::pair<std::int64_t, std::vector<Point<2>>>;

constexpr std::uint64_t kSide = 60;  ///< triangles of a square grid

LatticePoint vertex(std::uint64_t number) {
  const auto x = static_cast<double>(number % (kSide + 1));
  const auto y = static_cast<double>(number / (kSide + 1));
  return {x, y, 10 * std::sin(x / 3) * std::cos(y / 5) + x / 10};
}

std::vector<std::array<std::uint64_t, 3>> triangles() {
  std::vector<std::array<std::uint64_t, 3>> all;
  for (std::uint64_t y = 0; y < kSide; ++y) {
    for (std::uint64_t x = 0; x < kSide; ++x) {
      const std::uint64_t v = y * (kSide + 1) + x;
      all.push_back({v, v + 1, v + kSide + 2});
      all.push_back({v, v + kSide + 2, v + kSide + 1});
    }
  }
  return all;
}

/// A process of those that draw together.
class Process {
 public:
  explicit Process(std::uint64_t memory = 1 << 20, const LineTolerance& tolerance = {})
      : writer_(
            {.levels = Levels::every(0.5, 0), .tolerance = tolerance, .memory = memory},
            [this](std::span<const Point<2>> points, std::int64_t level) {
              store_.add(points, level);
              add(points, level);
            },
            *scratch_) {}

  void take(const std::array<std::uint64_t, 3>& triangle) {
    MeshStreamBlock mesh;
    std::vector<LatticePoint> vertices;
    for (const std::uint64_t v : triangle) {
      mesh.corners.push_back(static_cast<std::uint32_t>(mesh.imported.size()));
      mesh.imported.push_back(v);
      vertices.push_back(vertex(v));
    }
    writer_.take_merged({.mesh = mesh, .imported_vertices = vertices});
  }

  void add(std::span<const Point<2>> points, std::int64_t level) {
    lines_.emplace_back(level, std::vector<Point<2>>(points.begin(), points.end()));
  }

  [[nodiscard]] ContourWriter& writer() { return writer_; }
  [[nodiscard]] LineStore& store() { return store_; }

  std::vector<Line> finish() {
    writer_.finish({});
    std::sort(lines_.begin(), lines_.end());
    return lines_;
  }

 private:
  std::unique_ptr<ScratchFolder> scratch_ = make_scratch_folder(::testing::TempDir(), std::nullopt);
  LineStore store_{*scratch_};
  std::vector<Line> lines_;
  ContourWriter writer_;
};

/// Messages that wait to be had.
class Queue final : public ShareSender {
 public:
  explicit Queue(std::size_t message_bytes) : message_bytes_(message_bytes) {}
  [[nodiscard]] std::size_t message_bytes() const override { return message_bytes_; }
  void send(std::span<const std::byte> message) override {
    EXPECT_FALSE(message.empty());
    messages.emplace_back(message.begin(), message.end());
  }
  std::deque<std::vector<std::byte>> messages;

 private:
  std::size_t message_bytes_;
};

class Queues final : public OtherShares {
 public:
  explicit Queues(std::vector<Queue>& queues) : queues_(queues) {}
  [[nodiscard]] std::size_t count() const override { return queues_.size(); }
  std::optional<std::vector<std::byte>> next(std::size_t other) override {
    auto& messages = queues_[other].messages;
    if (messages.empty()) return std::nullopt;
    auto message = std::move(messages.front());
    messages.pop_front();
    return message;
  }

 private:
  std::vector<Queue>& queues_;
};

std::vector<Line> lines_of_one(const LineTolerance& tolerance = {}) {
  Process one(1 << 20, tolerance);
  for (const auto& triangle : triangles()) one.take(triangle);
  return one.finish();
}

void expect_lines_of_one(const LineTolerance& tolerance) {
  const std::vector<Line> expected = lines_of_one(tolerance);
  ASSERT_GT(expected.size(), 100U);
  for (const std::size_t message_bytes :
       {std::size_t{1}, std::size_t{1000}, std::size_t{1} << 20}) {
    for (const std::size_t count : {2, 5}) {
      std::deque<Process> processes;
      for (std::size_t p = 0; p < count; ++p) processes.emplace_back(message_bytes, tolerance);
      std::mt19937 random(7);
      for (const auto& triangle : triangles()) processes[random() % count].take(triangle);
      std::vector<Queue> queues(count - 1, Queue(message_bytes));
      for (std::size_t p = 1; p < count; ++p) {
        give_contours(processes[p].writer(), processes[p].store(), queues[p - 1]);
      }
      Queues others(queues);
      std::size_t figures_taken = 0;
      take_contours(
          processes[0].writer(), others,
          [&](std::span<const Point<2>> points, std::int64_t level) {
            processes[0].add(points, level);
          },
          [&](const ContourStatistics&) { ++figures_taken; });
      EXPECT_EQ(processes[0].finish(), expected) << count << " processes";
      EXPECT_EQ(figures_taken, count - 1);
    }
  }
}

TEST(ContourShares, OfTrianglesDealtAtRandomMakeTheLinesOfOneProcess) { expect_lines_of_one({}); }

TEST(ContourShares, OfTrianglesDealtAtRandomMakeTheSameLinesOfAnotherShape) {
  expect_lines_of_one({.smooth = 0.5});
  expect_lines_of_one({.smooth = 0.5, .simplify = 0.25});
}

/// Two strips of the grid, each numbered from 0 on in a block of its own, and what lies between
/// them: as a merge gives it, by numbers of the whole mesh.
TEST(ContourShares, AreNumberedAsTheWholeMesh) {
  const std::uint64_t middle = kSide / 2 * (kSide + 1);
  const std::uint64_t end = (kSide + 1) * (kSide + 1);
  Process below;
  Process above;
  const auto take_strip = [](Process& process, std::uint64_t first, std::uint64_t last) {
    MeshStreamBlock block;
    for (std::uint64_t v = first; v < last; ++v) block.vertices.push_back(vertex(v));
    for (const auto& triangle : triangles()) {
      if (triangle[0] < first || *std::ranges::max_element(triangle) >= last) continue;
      for (const std::uint64_t v : triangle) {
        block.corners.push_back(static_cast<std::uint32_t>(v - first));
      }
    }
    process.writer().write(std::move(block));
    process.writer().number_from(first);
  };
  take_strip(below, 0, middle);
  take_strip(above, middle, end);
  for (const auto& triangle : triangles()) {
    const auto [least, most] = std::ranges::minmax(triangle);
    if (least < middle && most >= middle) below.take(triangle);
  }
  std::vector<Queue> queues(1, Queue(5000));
  give_contours(above.writer(), above.store(), queues.front());
  Queues others(queues);
  double lowest = below.writer().lowest();
  take_contours(
      below.writer(), others,
      [&](std::span<const Point<2>> points, std::int64_t level) { below.add(points, level); },
      [&](const ContourStatistics& statistics) { lowest = std::min(lowest, statistics.lowest); });
  EXPECT_EQ(below.finish(), lines_of_one());
  EXPECT_EQ(lowest, std::min(below.writer().lowest(), above.writer().lowest()));
  EXPECT_LT(lowest, -5);
}

}  // namespace
}  // namespace spillway::test
