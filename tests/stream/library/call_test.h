#pragma once
// What tests of the library's calls have in common: a folder, a context, and values that streams
// hold.

#include <gtest/gtest.h>
#include <spillway/context.h>
#include <spillway/error.h>
#include <spillway/points.h>
#include <unistd.h>

#include <filesystem>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "tests/stream/library/error_code.h"

namespace spillway::test {

class CallTest : public ::testing::Test {
 protected:
  CallTest() {
    std::string name = ::testing::TempDir() + "spillway-test-call-XXXXXX";
    if (::mkdtemp(name.data()) != nullptr) folder_ = name;
  }
  ~CallTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string file(const std::string& name) const { return folder_ + "/" + name; }

  /// Its phases are written down.
  [[nodiscard]] ContextOptions options() {
    ContextOptions options;
    options.memory = "128M";
    options.threads = 2;
    options.scratch_folder = folder_;
    options.progress = [this](const Progress& told) {
      if (told.event == Progress::Event::kBegun) phases_.emplace_back(told.phase);
    };
    return options;
  }

  [[nodiscard]] ContextOptions stopped() {
    ContextOptions options = this->options();
    std::stop_source stop;
    stop.request_stop();
    options.stop = stop.get_token();
    return options;
  }

  std::string folder_;
  std::vector<std::string> phases_;
};

/// A program's own source.
class OwnPoints : public PointSource {
 public:
  explicit OwnPoints(std::vector<Point<3>> points, PointsHeader header = {})
      : points_(std::move(points)), header_(std::move(header)) {}

  [[nodiscard]] PointsHeader header() const override { return header_; }
  bool read(std::vector<Point<3>>& points) override {
    points = std::exchange(points_, {});
    return !points.empty();
  }

 private:
  std::vector<Point<3>> points_;
  PointsHeader header_;
};

/// A program's own sink.
class OwnSink : public PointSink {
 public:
  void begin(const PointsHeader& told) override { header = told; }
  void write(std::span<const Point<3>> some) override {
    points.insert(points.end(), some.begin(), some.end());
  }
  void finish() override { is_finished = true; }

  PointsHeader header;
  std::vector<Point<3>> points;
  bool is_finished = false;
};

inline std::vector<Point<3>> all_of(PointSource& source) {
  std::vector<Point<3>> all;
  for (std::vector<Point<3>> some; source.read(some);) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace spillway::test
