#pragma once
// Runs the built `spillway` the way people do: in a shell, in a folder of its own.

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace spillway::test {

struct Result {
  int exit_code;  ///< 128 + signal if it was killed
  std::string out;
  std::string err;
};

/// An empty folder that goes away with the object, and commands run in it.
class Workspace {
 public:
  Workspace();
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// Runs a shell script in which `spillway` is the built command. Standard input is empty.
  [[nodiscard]] Result run(const std::string& script) const;

  /// Runs a script that must succeed; fails the test with its messages otherwise. Returns its
  /// output.
  std::string succeed(const std::string& script) const;

  /// Starts the command itself, standard input a pipe that never ends, and returns its process id.
  [[nodiscard]] pid_t start(const std::vector<std::string>& arguments) const;

  /// What the command that was started last has written to standard error so far.
  [[nodiscard]] std::string messages() const;

  void write(const std::string& name, const std::string& content) const;
  [[nodiscard]] std::string read(const std::string& name) const;
  [[nodiscard]] bool has(const std::string& name) const;

  /// Whether a file of that name is being written, under a temporary one.
  [[nodiscard]] bool has_unfinished(const std::string& name) const;

  /// Names of all files, sorted.
  [[nodiscard]] std::vector<std::string> names() const;

  /// `spillway info --json` of a file.
  [[nodiscard]] nlohmann::json info(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path outputs_;  // where run() catches output, beside the folder
};

/// Waits for a started process. Returns its exit code, 128 + signal if it was killed.
int wait_for_exit(pid_t process);

/// Whether the command was built without `part`, "MPI" or "GDAL": by what its --version says. For
/// tests that skip what needs it.
bool build_lacks(const std::string& part);
inline constexpr const char* kNoGdal = "rasters, contours and the like take GDAL";

/// A file of the shared sample data, or an empty path if that folder is not there.
std::filesystem::path shared_file(const std::string& name);

}  // namespace spillway::test
