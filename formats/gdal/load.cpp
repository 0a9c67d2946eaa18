#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

constexpr const char* kModule = "spillway_gdal.so";

/// Where the module may lie, seen from the folder of the running program: beside it when built,
/// in the folder of libraries when installed.
constexpr std::array<std::string_view, 3> kFolders = {".", "../lib/spillway",
                                                      "../" SPILLWAY_LIBRARY_FOLDER "/spillway"};

std::filesystem::path program_folder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw Error("cannot find the program's own folder: " + error.message());
  return program.parent_path();
}

std::filesystem::path find_module() {
  const std::filesystem::path folder = program_folder();
  for (const std::string_view candidate : kFolders) {
    std::error_code ignored;  // what cannot be looked at is not there
    const std::filesystem::path path = (folder / candidate / kModule).lexically_normal();
    if (std::filesystem::is_regular_file(path, ignored)) return path;
  }
  throw Error(
      fmt::format("coordinate systems, GeoTIFF, GeoPackage and Shapefile need the module {}, which "
                  "is neither in {} nor in {}; install it",
                  kModule, folder.string(), (folder / kFolders[1]).lexically_normal().string()));
}

const Gdal& load() {
  const std::filesystem::path path = find_module();
  void* const module = ::dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  void* const factory = module == nullptr ? nullptr : ::dlsym(module, kGdalFactory);
  if (factory == nullptr) {
    const std::string reason = ::dlerror();
    const bool no_memory = reason.find("failed to map segment") != std::string::npos ||
                           reason.find("annot allocate memory") != std::string::npos;
    throw Error(fmt::format(
        "cannot load the module {}: {}; {}", path.string(), reason,
        no_memory ? "raise the limit of memory (ulimit -v)" : "install GDAL (libgdal)"));
  }
  return *reinterpret_cast<GdalFactory>(factory)();
}

}  // namespace

const Gdal& gdal() {
  static const Gdal& instance = load();
  return instance;
}

}  // namespace spillway::detail
