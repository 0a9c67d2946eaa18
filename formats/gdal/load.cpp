#include <dlfcn.h>
#include <fmt/format.h>
#include <spillway/version.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr const char* kModule = "spillway_gdal.so";

/// Where the module may lie, seen from the folder of the running program: beside it when built,
/// in the folder of libraries when installed. The last one is where this build is installed, for
/// programs that have the static library in them and lie anywhere.
constexpr std::array<std::string_view, 4> kFolders = {".", "../lib/spillway",
                                                      "../" SPILLWAY_LIBRARY_FOLDER "/spillway",
                                                      SPILLWAY_INSTALLED_LIBRARIES "/spillway"};
/// The same, seen from the folder of Spillway's shared library: when installed, when built, and in
/// the Python package.
constexpr std::array<std::string_view, 3> kLibraryFolders = {"spillway", "../bin", "."};

std::filesystem::path program_folder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) {
    throw SystemRefusal("cannot find the program's own folder: " + error.message(),
                        "/proc/self/exe", error.value());
  }
  return program.parent_path();
}

/// The folder of the file that this code is in: of a program that has it in itself, or of the
/// shared library. Empty if the system does not tell.
std::filesystem::path own_folder() {
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&own_folder), &info) == 0) return {};
  std::error_code ignored;
  return std::filesystem::canonical(info.dli_fname, ignored).parent_path();
}

/// Throws Failure if it is in none of the folders, the one that SPILLWAY_MODULES names first.
std::filesystem::path find_module() {
  if (const char* const named = std::getenv("SPILLWAY_MODULES")) {
    std::error_code ignored;
    const std::filesystem::path path = std::filesystem::path(named) / kModule;
    if (std::filesystem::is_regular_file(path, ignored)) return path;
  }
  const std::filesystem::path library = own_folder();
  for (const std::string_view candidate : kLibraryFolders) {
    std::error_code ignored;  // what cannot be looked at is not there
    const std::filesystem::path path = (library / candidate / kModule).lexically_normal();
    if (!library.empty() && std::filesystem::is_regular_file(path, ignored)) return path;
  }
  const std::filesystem::path folder = program_folder();
  for (const std::string_view candidate : kFolders) {
    std::error_code ignored;  // what cannot be looked at is not there
    const std::filesystem::path path = (folder / candidate / kModule).lexically_normal();
    if (std::filesystem::is_regular_file(path, ignored)) return path;
  }
  throw Failure(
      fmt::format("coordinate systems, GeoTIFF, GeoPackage and Shapefile need the module {}, which "
                  "is in none of {}, {} and {}; install it, or name its folder in SPILLWAY_MODULES",
                  kModule, folder.string(), (folder / kFolders[1]).lexically_normal().string(),
                  kFolders.back()),
      ErrorCode::kInputOutput, {.file = kModule, .system_error = ENOENT});
}

const Gdal& load() {
  const std::filesystem::path path = find_module();
  void* const module = ::dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  void* const factory = module == nullptr ? nullptr : ::dlsym(module, kGdalFactory);
  if (factory == nullptr) {
    const std::string reason = ::dlerror();
    const bool no_memory = reason.find("failed to map segment") != std::string::npos ||
                           reason.find("annot allocate memory") != std::string::npos;
    throw SystemRefusal(
        fmt::format("cannot load the module {}: {}; {}", path.string(), reason,
                    no_memory ? "raise the limit of memory (ulimit -v)" : "install GDAL (libgdal)"),
        path.string(), no_memory ? ENOMEM : 0);
  }
  void* const version = ::dlsym(module, kGdalVersion);
  const std::string_view its_own =
      version == nullptr ? "unknown" : reinterpret_cast<GdalVersion>(version)();
  if (its_own != SPILLWAY_VERSION_TEXT) {
    throw Failure(fmt::format("the module {} is of another version of Spillway: {}, where {} is "
                              "needed; install both of one version",
                              path.string(), its_own, SPILLWAY_VERSION_TEXT),
                  ErrorCode::kInputOutput, {.file = path.string()});
  }
  return *reinterpret_cast<GdalFactory>(factory)();
}

}  // namespace

const Gdal& gdal() {
  static const Gdal& instance = load();
  return instance;
}

}  // namespace spillway::formats
