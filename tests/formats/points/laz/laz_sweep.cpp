// laz_sweep FILE... [--truncate 97] [--flip 89] [--pipe] [--attributes] [--whole]: cuts each LAZ
// file off at every 97th byte and flips its every 89th byte, and tells what reading it gives. Exit
// code 1 if that is ever anything but points or an Error. Built with sanitizers it is the full
// trial of hostile input.
//
// Chunks are independent, so damage to a chunk is done to a file of this chunk alone; all other
// bytes are damaged in the whole file. Files that are cut off have lost their chunk table and so
// are read as they are, unless through a pipe.

#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/formats/points/laz/laz_encoder/laz_damage.h"
#include "tests/formats/points/laz/laz_encoder/laz_excerpt.h"

namespace {

using spillway::formats::PointBlock;
using spillway::test::DamageOutcome;
using spillway::test::LazCarried;

struct Settings {
  std::vector<std::string> files;
  std::size_t truncate = 97;
  std::size_t flip = 89;
  std::size_t thin = 1;
  unsigned mask = 255;
  unsigned threads = 1;
  bool pipe = false;
  bool all_attributes = false;
  bool whole = false;
  bool list = false;
  bool progress = false;

  [[nodiscard]] LazCarried carried() const {
    return all_attributes ? LazCarried::kAll : LazCarried::kFlags;
  }
};

/// How many runs ended in each way.
struct Counts {
  std::atomic<std::size_t> errors = 0;
  std::atomic<std::size_t> right = 0;
  std::atomic<std::size_t> other = 0;
  std::atomic<std::size_t> failures = 0;
};

std::size_t peak_memory_mib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) / 1024;
}

using Damage = std::function<void(std::string&, std::size_t)>;

/// A file and the bytes of it to damage.
struct Target {
  std::string bytes;
  PointBlock sound;
  std::vector<std::size_t> places;
  std::uint64_t shift = 0;  ///< of the places, to be those in the whole file
};

/// Reads the target damaged at each place, and counts.
void sweep(const Settings& settings, const Target& target, const Damage& damage, Counts& counts) {
  std::atomic<std::size_t> next = 0;
  std::mutex printing;
  const auto report = [&](std::size_t place, const char* what) {
    const std::lock_guard lock(printing);
    fmt::print("  byte {}: {}\n", place + target.shift, what);
  };
  const auto work = [&] {
    for (std::size_t i = next++; i < target.places.size(); i = next++) {
      const std::size_t place = target.places[i];
      std::string damaged = target.bytes;
      damage(damaged, place);
      try {
        const DamageOutcome outcome = spillway::test::read_damaged_laz(
            damaged, !settings.pipe, target.sound, settings.carried());
        if (settings.list && outcome == DamageOutcome::kOther) report(place, "other points");
        ++(outcome == DamageOutcome::kError   ? counts.errors
           : outcome == DamageOutcome::kRight ? counts.right
                                              : counts.other);
      } catch (const std::exception& failure) {
        ++counts.failures;
        report(place, failure.what());
      }
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned t = 0; t < settings.threads; ++t) threads.emplace_back(work);
}

/// A file to sweep, whole and cut into chunks.
class Sweep {
 public:
  Sweep(const Settings& settings, const std::string& name)
      : settings_(settings),
        name_(std::filesystem::path(name).filename().string()),
        bytes_(content_of(name)),
        sound_(spillway::test::read_laz(bytes_, !settings.pipe, settings.carried())),
        excerpts_(bytes_) {}

  /// Damages every `step`-th byte, in the file of its chunk if `in_chunks`; returns how many runs
  /// failed.
  std::size_t run(const char* what, std::size_t step, bool in_chunks, const Damage& damage) const {
    if (step == 0) return 0;
    Counts counts;
    std::size_t runs = 0;
    Target whole{bytes_, sound_, {}};
    const std::size_t chunks = in_chunks && !settings_.whole ? excerpts_.size() : 0;
    std::size_t at = 0;
    const auto take_places = [&](std::uint64_t end, Target& target) {
      for (; at < end; at += step * settings_.thin, ++runs) {
        target.places.push_back(at - target.shift);
      }
    };
    for (std::size_t i = 0; i < chunks; ++i) {
      const spillway::formats::LazChunk& chunk = excerpts_.chunk(i);
      take_places(chunk.offset, whole);
      Target part{excerpts_.file(i),
                  excerpts_.points(sound_, i),
                  {},
                  chunk.offset - excerpts_.offset_to_chunk()};
      take_places(chunk.offset + chunk.bytes, part);
      sweep(settings_, part, damage, counts);
      if (settings_.progress) {
        fmt::print(stderr, "{} {}: {} of {} chunks\n", name_, what, i + 1, chunks);
      }
    }
    take_places(bytes_.size(), whole);
    sweep(settings_, whole, damage, counts);
    fmt::print(
        "{:<45} {:<9} {:>7} runs {:>7} errors {:>6} right {:>7} other {:>3} failed {:>5} MiB\n",
        name_, what, runs, counts.errors.load(), counts.right.load(), counts.other.load(),
        counts.failures.load(), peak_memory_mib());
    std::fflush(stdout);
    return counts.failures;
  }

 private:
  static std::string content_of(const std::string& name) {
    std::ifstream stream(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  const Settings& settings_;
  std::string name_;
  std::string bytes_;
  PointBlock sound_;
  spillway::test::LazExcerpts excerpts_;
};

/// Sweeps one file; returns how many runs failed.
std::size_t sweep_file(const Settings& settings, const std::string& name) {
  const Sweep file(settings, name);
  std::size_t failures = file.run("truncated", settings.truncate, settings.pipe,
                                  [](std::string& damaged, std::size_t at) { damaged.resize(at); });
  failures += file.run("flipped", settings.flip, true, [&](std::string& damaged, std::size_t at) {
    damaged[at] = static_cast<char>(static_cast<unsigned>(damaged[at]) ^ settings.mask);
  });
  return failures;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app(
      "Reads LAZ files truncated and flipped at many places. Damage to a chunk is done to a file "
      "of this chunk alone, as chunks are independent.");
  app.add_option("FILE", settings.files, "LAZ files")->required()->check(CLI::ExistingFile);
  app.add_option("--truncate", settings.truncate, "cut off at every Nth byte; 0: never");
  app.add_option("--flip", settings.flip, "flip every Nth byte; 0: none");
  app.add_option("--mask", settings.mask, "bits to flip")->check(CLI::Range(1, 255));
  app.add_option("--thin", settings.thin, "only every Nth of these")->check(CLI::PositiveNumber);
  app.add_option("--threads", settings.threads, "runs at a time")->check(CLI::PositiveNumber);
  app.add_flag("--pipe", settings.pipe, "read as from a pipe");
  app.add_flag("--attributes", settings.all_attributes, "decode all attributes of points");
  app.add_flag("--whole", settings.whole, "damage chunks in the whole file, which takes hours");
  app.add_flag("--list", settings.list, "name the places that give other points");
  app.add_flag("--progress", settings.progress, "name each chunk that is done");
  CLI11_PARSE(app, argc, argv);
  std::size_t failures = 0;
  try {
    for (const std::string& file : settings.files) failures += sweep_file(settings, file);
  } catch (const std::exception& error) {
    fmt::print(stderr, "laz_sweep: {}\n", error.what());
    return 1;
  }
  return failures == 0 ? 0 : 1;
}
