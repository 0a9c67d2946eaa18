#include "tests/formats/points/laz/laz_encoder/laz_damage.h"

#include <algorithm>
#include <stdexcept>

#include "formats/inputs/open_points.h"
#include "src/error.h"
#include "tests/faulty_file_system.h"
#include "tests/formats/points/las_flags_layout.h"

namespace spillway::test {
namespace {

constexpr const char* kName = "a.laz";

/// Calls `take` with each block.
template <typename F>
void for_each_block(const std::string& content, bool seekable, LazCarried carried, F&& take) {
  FaultyFileSystem files;
  files.seekable = seekable;
  files.files[kName] = content;
  PointReaderOptions options;
  options.keep_withheld = true;
  const auto reader = open_point_reader(files, kName, options);
  reader->carry(carried == LazCarried::kAll ? reader->header().attributes : flags_layout());
  PointBlock block;
  while (reader->read(block)) take(block);
}

template <typename T>
bool continues(const std::vector<T>& part, const std::vector<T>& whole, std::size_t at) {
  return part.size() <= whole.size() - std::min(at, whole.size()) &&
         std::equal(part.begin(), part.end(), whole.begin() + static_cast<std::ptrdiff_t>(at));
}

}  // namespace

PointBlock read_laz(const std::string& content, bool seekable, LazCarried carried) {
  PointBlock all;
  for_each_block(content, seekable, carried, [&](const PointBlock& block) {
    all.points.insert(all.points.end(), block.points.begin(), block.points.end());
    all.index.insert(all.index.end(), block.index.begin(), block.index.end());
    all.attributes.insert(all.attributes.end(), block.attributes.begin(), block.attributes.end());
  });
  return all;
}

DamageOutcome read_damaged_laz(const std::string& content, bool seekable, const PointBlock& sound,
                               LazCarried carried) {
  const std::size_t endless = 1000 * sound.size() + 10000000;
  std::size_t count = 0;
  bool same = true;
  try {
    for_each_block(content, seekable, carried, [&](const PointBlock& block) {
      same = same && continues(block.points, sound.points, count) &&
             continues(block.attributes, sound.attributes, count * block.record_size());
      count += block.size();
      if (count > endless) throw std::logic_error("points without end");
    });
  } catch (const Failure& error) {
    const std::string message = error.what();
    if (!message.starts_with(std::string(kName) + ": ") || message.find('\n') != message.npos) {
      throw std::logic_error("a bad message: " + message);
    }
    return DamageOutcome::kError;
  }
  return same && count == sound.size() ? DamageOutcome::kRight : DamageOutcome::kOther;
}

}  // namespace spillway::test
