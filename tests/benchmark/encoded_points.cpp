// encoded_points FILE... --output-dir DIR: files of points on a lattice as LAZ or COPC, as in
// encoded_files.h. One file is in memory for each thread.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "formats/disk/file_system.h"
#include "tests/formats/points/copc/encoded_files.h"

namespace spillway::test {
namespace {

struct Plan {
  std::vector<std::string> files;
  std::string folder;
  bool copc = false;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
};

void encode(const std::string& path, const Plan& plan) {
  const EncodedPoints points = read_points_to_encode(path);
  const std::string bytes = plan.copc ? copc_bytes(points) : laz_bytes(points);
  const std::filesystem::path name = std::filesystem::path(path).stem();
  const auto file = disk().create(std::filesystem::path(plan.folder) /
                                  (name.string() + (plan.copc ? ".copc.laz" : ".laz")));
  file->write(std::as_bytes(std::span(bytes)));
  file->commit();
}

/// Encodes all files; throws what the first thread that failed has thrown.
void run(const Plan& plan) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < plan.files.size(); i = next++) encode(plan.files[i], plan);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!failure) failure = std::current_exception();
      next = plan.files.size();
    }
  };
  {
    std::vector<std::jthread> threads(plan.threads);
    for (std::jthread& thread : threads) thread = std::jthread(work);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace
}  // namespace spillway::test

int main(int argc, char** argv) {
  spillway::test::Plan plan;
  CLI::App app("Writes files of points on a lattice as LAZ or COPC, one for each");
  app.add_option("FILE", plan.files, "LAS, or another format with a lattice")->required();
  app.add_option("--output-dir", plan.folder, "Folder of the files, which must be there")
      ->required();
  app.add_flag("--copc", plan.copc, "COPC with point format 6 instead of LAZ with 0");
  app.add_option("--threads", plan.threads, "Files at a time")->check(CLI::Range(1, 256));
  CLI11_PARSE(app, argc, argv);
  try {
    spillway::test::run(plan);
  } catch (const std::exception& error) {
    fmt::print(stderr, "encoded_points: {}\n", error.what());
    return 1;
  }
  return 0;
}
