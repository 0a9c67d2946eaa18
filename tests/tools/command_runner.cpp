#include "tests/tools/command_runner.h"
#include "tests/test_paths.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace spillway::test {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// File actions and attributes of a process to be started.
struct SpawnSettings {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;

  SpawnSettings() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    // Whatever the test's own parent did: signals act as from a terminal.
    sigset_t all;
    sigset_t none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  void catch_output(int descriptor, const fs::path& file) {
    posix_spawn_file_actions_addopen(&actions, descriptor, file.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
  }
};

pid_t spawn(const SpawnSettings& settings, const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_t process = 0;
  if (posix_spawn(&process, argv[0], &settings.actions, &settings.attributes, argv.data(),
                  environ) != 0) {
    throw std::runtime_error("cannot start " + arguments.front());
  }
  return process;
}

}  // namespace

Workspace::Workspace() {
  std::string name = (fs::temp_directory_path() / "spillway-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot create " + name);
  outputs_ = name;
  folder_ = outputs_ / "work";
  fs::create_directory(folder_);
}

Workspace::~Workspace() {
  std::error_code ignored;
  fs::remove_all(outputs_, ignored);
}

Result Workspace::run(const std::string& script) const {
  SpawnSettings settings;
  posix_spawn_file_actions_addchdir_np(&settings.actions, folder_.c_str());
  posix_spawn_file_actions_addopen(&settings.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  settings.catch_output(STDOUT_FILENO, outputs_ / "stdout");
  settings.catch_output(STDERR_FILENO, outputs_ / "stderr");
  const std::string command = "spillway() { '" + command_path() + "' \"$@\"; }\n" + script;
  const int exit_code = wait_for_exit(spawn(settings, {"/bin/sh", "-c", command}));
  return {exit_code, content_of(outputs_ / "stdout"), content_of(outputs_ / "stderr")};
}

std::string Workspace::succeed(const std::string& script) const {
  const Result result = run("set -e\n" + script);
  EXPECT_EQ(result.exit_code, 0) << script << "\n" << result.err;
  return result.out;
}

pid_t Workspace::start(const std::vector<std::string>& arguments) const {
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  SpawnSettings settings;
  posix_spawn_file_actions_addchdir_np(&settings.actions, folder_.c_str());
  posix_spawn_file_actions_adddup2(&settings.actions, pipe_ends[0], STDIN_FILENO);
  settings.catch_output(STDERR_FILENO, outputs_ / "stderr");
  std::vector<std::string> command = {command_path()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const pid_t process = spawn(settings, command);
  close(pipe_ends[0]);  // the writing end stays open until this test program ends
  return process;
}

std::string Workspace::messages() const { return content_of(outputs_ / "stderr"); }

void Workspace::write(const std::string& name, const std::string& content) const {
  std::ofstream(folder_ / name, std::ios::binary) << content;
}

std::string Workspace::read(const std::string& name) const { return content_of(folder_ / name); }

bool Workspace::has(const std::string& name) const { return fs::exists(folder_ / name); }

bool Workspace::has_unfinished(const std::string& name) const {
  const fs::path path = folder_ / name;
  std::error_code missing;
  for (fs::directory_iterator entry(path.parent_path(), missing), end; !missing && entry != end;
       entry.increment(missing)) {
    const std::string found = entry->path().filename();
    if (found.starts_with(path.filename().string() + ".") && found.ends_with(".part")) return true;
  }
  return false;
}

std::vector<std::string> Workspace::names() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

nlohmann::json Workspace::info(const std::string& name) const {
  return nlohmann::json::parse(succeed("spillway info -q --json '" + name + "'"), nullptr, false);
}

int wait_for_exit(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool build_lacks(const std::string& part) {
  static const std::string version = Workspace().succeed("spillway --version");
  return version.find("without " + part) != std::string::npos;
}

fs::path shared_file(const std::string& name) {
  const fs::path path = shared_data_folder() / name;
  return fs::exists(path) ? path : fs::path();
}

}  // namespace spillway::test
