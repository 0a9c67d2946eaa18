// laz_benchmark FILE...: reads each file to its end, on one thread and on several, and prints one
// Markdown table; with --records, decodes the chunks of LAZ files to whole records and encodes them
// again, on one thread. Medians over the repetitions, after one run that warms the caches.
// Where other programs share the processor, processor time is the better measure of one thread.

#include <fmt/format.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "formats/bytes/bytes.h"
#include "formats/bytes/input_bytes.h"
#include "formats/disk/file_system.h"
#include "formats/inputs/open_points.h"
#include "formats/points/common/point_reader.h"
#include "formats/points/las/las_header.h"
#include "formats/points/laz/chunk_decoder.h"
#include "formats/points/laz/chunk_encoder.h"
#include "formats/points/laz/chunk_table.h"
#include "src/error.h"
#include "tests/formats/points/laz/laz_encoder/decoded_records.h"

namespace spillway::test {
namespace {

struct Plan {
  std::vector<std::string> files;
  unsigned repetitions = 5;
  unsigned threads = 2;
  bool attributes = false;
  bool keep_withheld = false;
  bool records = false;
};

/// Takes pieces in turns with other threads, and decodes them beside each other.
void work(PointReader& reader, std::mutex& fetching, std::uint64_t& points) {
  RawPoints raw;
  PointBlock block;
  for (;;) {
    {
      const std::scoped_lock lock(fetching);
      if (!reader.fetch(raw)) return;
    }
    reader.decode(raw, block);
    points += block.size();
  }
}

double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

struct Speed {
  double by_clock = 0;      ///< million points a second
  double by_processor = 0;  ///< million points a second of processor time, all threads together
  std::uint64_t points = 0;
};

/// Reads the file once, from opening it on.
Speed read_file(const Plan& plan, const std::string& file, unsigned threads) {
  const double start = seconds_of(CLOCK_MONOTONIC);
  const double start_processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  PointReaderOptions options;
  options.keep_withheld = plan.keep_withheld;
  const auto reader = open_point_reader(disk(), file, options);
  if (plan.attributes) {
    reader->carry(chosen(reader->header().attributes,
                         {.names = {"classification", "return_number", "number_of_returns"}}));
  }
  std::mutex fetching;
  std::vector<std::uint64_t> of_thread(threads);
  std::vector<std::thread> workers;
  for (unsigned i = 1; i < threads; ++i) {
    workers.emplace_back([&, i] { work(*reader, fetching, of_thread[i]); });
  }
  work(*reader, fetching, of_thread[0]);
  for (std::thread& worker : workers) worker.join();
  Speed speed;
  speed.points = std::accumulate(of_thread.begin(), of_thread.end(), std::uint64_t{0});
  const double millions = static_cast<double>(speed.points) * 1e-6;
  speed.by_clock = millions / (seconds_of(CLOCK_MONOTONIC) - start);
  speed.by_processor = millions / (seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start_processor);
  return speed;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Speed median_speed(const Plan& plan, const std::string& file, unsigned threads) {
  std::vector<double> by_clock;
  std::vector<double> by_processor;
  Speed speed = read_file(plan, file, threads);
  for (unsigned r = 0; r < plan.repetitions; ++r) {
    speed = read_file(plan, file, threads);
    by_clock.push_back(speed.by_clock);
    by_processor.push_back(speed.by_processor);
  }
  return {median(by_clock), median(by_processor), speed.points};
}

/// The chunks of a LAZ file.
struct Chunks {
  struct Chunk {
    std::vector<std::byte> bytes;
    std::uint64_t count;
  };

  LazChunkFormat format;
  std::vector<Chunk> chunks;
  std::uint64_t points = 0;
};

Chunks chunks_of(const std::string& file) {
  InputBytes source(disk().open(file));
  const LasHeader las = read_las_header(source);
  const std::optional<LazChunkTable> table = las.laz ? read_chunk_table(source, las) : std::nullopt;
  if (!table) throw Failure(fmt::format("{} has no chunks of LAZ", file));
  Chunks chunks{.format = las.laz->format, .chunks = {}};
  for (const LazChunk& place : table->chunks) {
    Chunks::Chunk& chunk = chunks.chunks.emplace_back();
    chunk.bytes.resize(place.bytes);
    chunk.count = place.count;
    source.seek(place.offset);
    source.read(chunk.bytes);
    chunks.points += place.count;
  }
  return chunks;
}

/// Decodes as a reader does, with one decoder for all chunks; gives the records of each chunk.
std::vector<std::string> decode(const Chunks& chunks) {
  LazChunkDecoder decoder(chunks.format, LazDetail::kRecords);
  const std::size_t length = record_length_of(chunks.format);
  std::vector<std::string> records;
  for (const Chunks::Chunk& chunk : chunks.chunks) {
    records.push_back(decode_laz_records(decoder, length, chunk.bytes, chunk.count));
  }
  return records;
}

/// Encodes as a writer does; returns how many bytes that takes.
std::uint64_t encode(const LazChunkFormat& format, const std::vector<std::string>& records) {
  std::uint64_t bytes = 0;
  std::vector<std::byte> encoded;
  for (const std::string& of_chunk : records) {
    encoded.clear();
    LazChunkEncoder(format).encode(as_bytes_of(of_chunk), encoded);
    bytes += encoded.size();
  }
  return bytes;
}

/// The median of million points a second of processor time.
template <typename Work>
double median_speed_of(const Plan& plan, std::uint64_t points, Work&& work) {
  std::vector<double> speeds;
  for (unsigned r = 0; r < plan.repetitions; ++r) {
    const double start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    work();
    const double seconds = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start;
    speeds.push_back(static_cast<double>(points) * 1e-6 / seconds);
  }
  return median(speeds);
}

void print_records_table(const Plan& plan) {
  fmt::print(
      "| file | points | bytes a record | decoded by processor time, million records/s | encoded | "
      "size ratio |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  for (const std::string& file : plan.files) {
    const Chunks chunks = chunks_of(file);
    const std::vector<std::string> records = decode(chunks);
    const std::uint64_t bytes = encode(chunks.format, records);
    std::uint64_t bytes_before = 0;
    for (const Chunks::Chunk& chunk : chunks.chunks) bytes_before += chunk.bytes.size();
    const double decoding = median_speed_of(plan, chunks.points, [&] { decode(chunks); });
    const double encoding =
        median_speed_of(plan, chunks.points, [&] { encode(chunks.format, records); });
    fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | {:.3f} |\n",
               std::filesystem::path(file).filename().string(), chunks.points,
               record_length_of(chunks.format), decoding, encoding,
               static_cast<double>(bytes) / static_cast<double>(bytes_before));
  }
}

void print_table(const Plan& plan) {
  fmt::print(
      "| file | points | 1 thread, million points/s | by processor time | {} threads | ratio |\n",
      plan.threads);
  fmt::print("|---|---|---|---|---|---|\n");
  for (const std::string& file : plan.files) {
    const Speed one = median_speed(plan, file, 1);
    const Speed several = median_speed(plan, file, plan.threads);
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n",
               std::filesystem::path(file).filename().string(), one.points, one.by_clock,
               one.by_processor, several.by_clock, several.by_clock / one.by_clock);
  }
}

}  // namespace
}  // namespace spillway::test

int main(int argc, char** argv) {
  spillway::test::Plan plan;
  CLI::App app("Times the reading of LAZ and other point files, and whole records of LAZ");
  app.add_option("files", plan.files)->required();
  app.add_option("-r,--repetitions", plan.repetitions)->check(CLI::Range(1, 1000));
  app.add_option("--threads", plan.threads, "in the second turn")->check(CLI::Range(1, 1024));
  app.add_flag("--attributes", plan.attributes, "also classes, returns and flags");
  app.add_flag("--keep-withheld", plan.keep_withheld, "flags are not needed, then");
  app.add_flag("--records", plan.records,
               "decode chunks of LAZ to whole records, and encode them again, instead of reading");
  CLI11_PARSE(app, argc, argv);
  try {
    if (plan.records) {
      spillway::test::print_records_table(plan);
    } else {
      spillway::test::print_table(plan);
    }
  } catch (const spillway::runtime::Failure& error) {
    fmt::print(stderr, "laz_benchmark: {}\n", error.what());
    return 1;
  }
  return 0;
}
