#include "formats/disk/output_target.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "src/error.h"

namespace spillway::formats {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kPermissions = 0777;

std::string through_links(const std::string& name) {
  constexpr int kMostLinks = 40;  // as many as the system follows
  fs::path target = name;
  std::error_code no_link;
  for (int i = 0; i < kMostLinks; ++i) {
    const fs::path next = fs::read_symlink(target, no_link);
    if (no_link) break;
    target = target.parent_path() / next;
  }
  return target.string();
}

}  // namespace

std::string output_hint(int error, const std::string& name) {
  const std::string parent = fs::path(name).parent_path().string();
  const std::string folder = parent.empty() ? "." : parent;
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return fmt::format("; create the folder {} first", folder);
    case EACCES:
    case EPERM:
    case EROFS:
      return fmt::format("; choose a folder other than {}, or change its permissions", folder);
    case ENOSPC:
    case EDQUOT:
      return "; free some space or write to another disk";
    case EFBIG:
      return "; raise the file size limit (ulimit -f) or write to another file system";
    case ENAMETOOLONG:
      return "; choose a shorter name";
    case EISDIR:
      return "; name a file in it";
    case EMFILE:
    case ENFILE:
      return "; raise the limit of open files (ulimit -n)";
    default:
      return "";
  }
}

void fail_to_create(const std::string& name, int error) {
  throw SystemRefusal(fmt::format("cannot create {}: {}{}", name,
                                  std::generic_category().message(error), output_hint(error, name)),
                      name, error);
}

OutputTarget output_target(const std::string& name) {
  if (name.empty()) throw InvalidArgument("cannot create a file without a name; name the output");
  OutputTarget target;
  struct stat status {};
  if (::stat(name.c_str(), &status) != 0) {
    if (errno != ENOENT) fail_to_create(name, errno);
    target.path = through_links(name);
    return target;
  }
  if (S_ISDIR(status.st_mode)) fail_to_create(name, EISDIR);
  target.regular = S_ISREG(status.st_mode);
  target.path = target.regular ? through_links(name) : name;
  if (!target.regular) return target;
  if (::access(name.c_str(), W_OK) != 0) {
    const int error = errno;
    throw SystemRefusal(
        fmt::format("cannot create {}: {}; the file is there and write-protected, choose another "
                    "name",
                    name, std::generic_category().message(error)),
        name, error);
  }
  target.mode = status.st_mode & kPermissions;
  return target;
}

}  // namespace spillway::formats
