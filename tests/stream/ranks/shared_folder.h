#pragma once
// A folder for a test that all ranks run.

#include <unistd.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "formats/bytes/bytes.h"
#include "tests/distributed/world.h"

namespace spillway::test {

/// An empty folder that all ranks know by the same name; removed when all are done with it.
class SharedFolder {
 public:
  SharedFolder() {
    std::vector<std::byte> name;
    if (world().rank() == 0) {
      path_ = ::testing::TempDir() + "rank-output" + std::to_string(::getpid());
      std::filesystem::create_directory(path_);
      const auto bytes = as_bytes_of(path_);
      name.assign(bytes.begin(), bytes.end());
    }
    world().broadcast(name, 0);
    path_ = as_text(name);
  }
  ~SharedFolder() {
    world().barrier();
    if (world().rank() == 0) std::filesystem::remove_all(path_);
  }
  SharedFolder(const SharedFolder&) = delete;
  SharedFolder& operator=(const SharedFolder&) = delete;

  [[nodiscard]] std::string operator/(const std::string& name) const { return path_ + "/" + name; }

  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      names.insert(entry.path().filename());
    }
    return names;
  }

 private:
  std::string path_;
};

}  // namespace spillway::test
