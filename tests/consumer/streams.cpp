// Points and meshes that stream; docs/library.md explains it with the same code.

#include "streams.h"

#include <spillway/convert.h>
#include <spillway/triangulate.h>

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

void expect(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

/// A folder of its own, removed with all that is in it.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "consumer-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string file(const char* name) const { return (path_ / name).string(); }
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

// A source of one's own: hills that nobody has measured.
class Hills : public spillway::PointSource {
 public:
  explicit Hills(std::uint64_t count) : count_(count) {}

  spillway::PointsHeader header() const override { return {.count = count_}; }

  bool read(std::vector<spillway::Point<3>>& points) override {
    points.clear();
    for (; points.size() < 10'000 && made_ < count_; ++made_) {
      const double x = place_(random_);
      const double y = place_(random_);
      points.push_back({x, y, x * y});
    }
    return !points.empty();
  }

 private:
  std::uint64_t count_;
  std::uint64_t made_ = 0;
  std::mt19937_64 random_{7};
  std::uniform_real_distribution<double> place_{0, 1000};
};

// A sink of one's own: counts, and never holds more than the vertices in use.
class Counter : public spillway::MeshSink {
 public:
  void write(const spillway::MeshBlock& block) override {
    live_ += block.vertices.size();
    most_live_ = live_ > most_live_ ? live_ : most_live_;
    live_ -= block.finalized.size();
    corners_ += block.corners.size();
  }
  void finish(const spillway::MeshTotals& totals) override { totals_ = totals; }

  std::uint64_t live_ = 0;
  std::uint64_t most_live_ = 0;
  std::uint64_t corners_ = 0;
  spillway::MeshTotals totals_;
};

// Points of four dimensions.
void stream_four_dimensions() {
  std::vector<spillway::Point<4>> samples;
  for (int i = 0; i < 2'000; ++i) {
    samples.push_back({std::sin(i), std::sin(2.1 * i), std::sin(3.3 * i), std::sin(5.7 * i)});
  }
  const spillway::Context large({.memory = "1G"});
  const auto of_four = spillway::points_in_memory(spillway::PointView<4>(samples));
  spillway::MeshInMemory simplices;
  spillway::triangulate(*of_four, simplices, {.dimension = 4}, large);
  const std::vector<spillway::Point<4>> vertices = simplices.coordinates<4>();

  expect(vertices.size() == samples.size(), "all points are vertices");
  expect(simplices.corners().size() > 5 * 20 * samples.size(), "they have many simplices");
}

// More points than memory: they wait in scratch files, and triangles come while they are made.
void stream_more_than_memory(const Folder& folder) {
  const spillway::Context context({.memory = "32M", .threads = 2, .scratch_folder = folder.path()});
  Hills hills(1'500'000);  // 36 MB of coordinates
  Counter counter;
  const spillway::Report report = spillway::triangulate(hills, counter, {}, context);

  std::printf("%llu triangles, %llu of %llu vertices in use at most, %llu points spilled\n",
              static_cast<unsigned long long>(report.mesh.simplices),
              static_cast<unsigned long long>(counter.most_live_),
              static_cast<unsigned long long>(report.mesh.vertices),
              static_cast<unsigned long long>(report.spilled_points));
  expect(report.points.read == 1'500'000, "all points are read");
  expect(report.spilled_points > 0, "what does not fit into memory is spilled");
  expect(counter.totals_ == report.mesh, "the sink is told the totals");
  expect(counter.corners_ == 3 * report.mesh.simplices, "all triangles come");
  expect(counter.live_ == 0, "all vertices are finalized");
  expect(counter.most_live_ < report.mesh.vertices / 4, "few vertices are in use at a time");
  expect(fs::is_empty(folder.path()), "scratch files are gone");
}

// From arrays to a file, from files to memory.
void convert_ways(const Folder& folder) {
  const spillway::Context context({.memory = "64M", .scratch_folder = folder.path()});
  std::vector<spillway::Point<3>> points;
  for (int x = 0; x < 100; ++x) {
    for (int y = 0; y < 100; ++y) points.push_back({x + 0.5, y + 0.25, 0.001 * x * y});
  }
  const auto source = spillway::points_in_memory(points);
  const auto file = spillway::create_mesh(folder.file("tin.ply"), {}, context);
  const auto report = spillway::triangulate(*source, *file, {}, context);
  expect(report.mesh.simplices == 2 * 99 * 99, "a grid has two triangles a square");
  expect(fs::file_size(folder.file("tin.ply")) > 200'000, "the file is there");

  std::ofstream text(folder.file("points.txt"));
  text.precision(17);
  for (const auto& [x, y, z] : points) text << x << ' ' << y << ' ' << z << '\n';
  text.close();
  spillway::PointOptions part;
  part.bounds = {{0, 0, -1e9}, {50, 1000, 1e9}};
  const auto read = spillway::open_points({folder.file("*.txt")}, part, context);
  spillway::MeshInMemory mesh;
  const auto half = spillway::triangulate(*read, mesh, {.input_index = true}, context);
  expect(half.points.bounds == 5000, "half of the points are outside of the bounds");
  expect(mesh.vertices().size() == 5000 && mesh.corners().size() == 3 * mesh.totals().simplices,
         "the mesh is in memory");
  const std::uint64_t index = mesh.input_index().at(17);
  expect(mesh.vertices().at(17) == points.at(index), "vertices know their index");
}

// Points that carry something: from the program to a file, and back.
void carry_attributes(const Folder& folder) {
  const spillway::Context context({.memory = "64M", .scratch_folder = folder.path()});
  const std::vector<spillway::Point<3>> points{{0, 0, 1}, {4, 0, 2}, {4, 3, 3}};
  spillway::AttributeColumns carried(
      {{.name = "intensity", .type = spillway::NumberType::kUint16}, {.name = "depth"}},
      points.size());
  carried.values<std::uint16_t>("intensity")[2] = 700;
  carried.values<double>("depth")[2] = -1.5;
  const auto file = spillway::create_points(folder.file("survey.las"), {}, context);
  spillway::convert(*spillway::points_in_memory(points, carried), *file, context);

  spillway::PointOptions with;
  with.attributes = {"intensity", "depth"};
  const auto read = spillway::open_points({folder.file("survey.las")}, with, context);
  spillway::PointsBlock block;
  while (read->read(block)) {
    const auto intensities = block.attributes.values<std::uint16_t>("intensity");
    const std::vector<double> depths = block.attributes.meant("depth");
    expect(intensities[2] == 700 && depths[2] == -1.5, "attributes come back");
  }
}

// The error that the work ends with.
template <typename Work>
spillway::Error fault_of(Work&& work) {
  try {
    work();
  } catch (const spillway::Error& error) {
    const spillway::ErrorFacts& facts = error.facts();
    std::printf("%s: %s\n", to_string(error.code()), error.what());
    if (facts.place.unit != spillway::PlaceUnit::kNone) {
      std::printf("  at %s %llu of %s\n", to_string(facts.place.unit),
                  static_cast<unsigned long long>(facts.place.number), facts.file.c_str());
    }
    return error;
  }
  throw std::logic_error("an error is thrown");
}

// Points on a circle: no triangle is final before all of them are there.
std::vector<spillway::Point<2>> circle(std::size_t count) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> turn(0, 6.28);
  std::vector<spillway::Point<2>> points(count);
  for (auto& point : points) {
    const double angle = turn(random);
    point = {1000 * std::cos(angle), 1000 * std::sin(angle)};
  }
  return points;
}

void catch_errors_of_streams(const Folder& folder) {
  using spillway::ErrorCode;
  const spillway::Context context({.memory = "32M", .scratch_folder = folder.path()});
  const auto run = [&](spillway::PointSource& source, const spillway::Context& with) {
    spillway::MeshInMemory mesh;
    spillway::triangulate(source, mesh, {}, with);
  };
  const auto open = [&](const char* name) {
    return spillway::open_points({folder.file(name)}, {}, context);
  };
  const auto create = [&](const char* name) {
    Hills hills(100);
    spillway::triangulate(hills, *spillway::create_mesh(folder.file(name), {}, context), {},
                          context);
  };

  expect(fault_of([&] { spillway::Context bad({.memory = "much"}); }).code() ==
             ErrorCode::kInvalidArgument,
         "a limit is a size");
  expect(fault_of([&] { spillway::create_mesh(folder.file("tin.doc"), {}, context); }).code() ==
             ErrorCode::kInvalidArgument,
         "a format is known");

  const auto missing = fault_of([&] { open("nowhere.las"); });
  expect(missing.code() == ErrorCode::kInputOutput, "what is not there is not read");
  expect(missing.facts().file == folder.file("nowhere.las"), "the file is named");
  expect(missing.facts().system_error == ENOENT, "so is the system's reason");
  const auto no_folder = fault_of([&] { create("nowhere/tin.ply"); });
  expect(no_folder.code() == ErrorCode::kInputOutput && no_folder.facts().system_error == ENOENT,
         "nothing is written to a folder that is not there");

  std::ofstream(folder.file("cut.las")) << "LASF and no more";
  const auto cut = fault_of([&] { open("cut.las"); });
  expect(cut.code() == ErrorCode::kBadInput, "a cut file is not read");
  expect(cut.facts().place.unit == spillway::PlaceUnit::kByte && cut.facts().place.number == 16,
         "it ends at that byte");
  std::ofstream(folder.file("typo.txt")) << "1 2 3\n4 5 6\n7 8 g\n";
  const auto typo = fault_of([&] { run(*open("typo.txt"), context); });
  expect(typo.code() == ErrorCode::kBadInput, "text is made of numbers");
  expect(typo.facts().file == folder.file("typo.txt") &&
             typo.facts().place.unit == spillway::PlaceUnit::kLine &&
             typo.facts().place.number == 3,
         "the line is named");

  Hills few(2);
  expect(fault_of([&] { run(few, context); }).code() == ErrorCode::kDegenerateInput,
         "two points make no triangle");

  const std::vector<spillway::Point<2>> round = circle(90'000);
  const auto full = fault_of([&] { run(*spillway::points_in_memory(round), context); });
  expect(full.code() == ErrorCode::kOutOfBudget, "a limit of memory holds");
  const std::uint64_t enough = full.facts().enough;
  expect(enough > std::uint64_t{32} << 20, "what is enough is known");
  const std::string as_said = std::to_string(enough >> 20) + "M";
  run(*spillway::points_in_memory(round),
      spillway::Context({.memory = as_said, .scratch_folder = folder.path()}));

  const spillway::Context tight(
      {.memory = "32M", .scratch_folder = folder.path(), .scratch_limit = "1M"});
  Hills many(1'500'000);
  expect(fault_of([&] { run(many, tight); }).code() == ErrorCode::kOutOfBudget,
         "a limit of scratch files holds");
  expect(!fs::exists(folder.file("tin.doc")), "nothing is left of what failed");
}

void stop_a_run(const Folder& folder) {
  std::stop_source stop;
  spillway::ContextOptions options;
  options.memory = "32M";
  options.scratch_folder = folder.path();
  options.stop = stop.get_token();
  options.progress = [&](const spillway::Progress& progress) {
    if (progress.phase == "triangulate" && progress.done > 100'000) stop.request_stop();
  };
  const spillway::Context context(std::move(options));
  Hills hills(1'500'000);
  const auto file = spillway::create_mesh(folder.file("stopped.spm"), {}, context);
  expect(fault_of([&] { spillway::triangulate(hills, *file, {}, context); }).code() ==
             spillway::ErrorCode::kInterrupted,
         "a run can be stopped");
  expect(!fs::exists(folder.file("stopped.spm")), "a file that was stopped has no name");
}

}  // namespace

void use_streams() {
  {
    const Folder folder;
    stream_more_than_memory(folder);
  }
  stream_four_dimensions();
  const Folder folder;
  convert_ways(folder);
  carry_attributes(folder);
  catch_errors_of_streams(folder);
  stop_a_run(folder);
}
