#include "formats/gdal/module/gdal_errors.h"

#include <cpl_error.h>

#include <algorithm>

namespace spillway::formats {
namespace {

std::string& first_failure() {
  thread_local std::string text;
  return text;
}

void keep_first_failure(CPLErr severity, CPLErrorNum /*number*/, const char* message) {
  if (severity >= CE_Failure && first_failure().empty()) first_failure() = message;
}

}  // namespace

void silence_gdal() { CPLSetErrorHandler(keep_first_failure); }

void forget_gdal_errors() {
  CPLErrorReset();
  first_failure().clear();
}

std::string gdal_reason() {
  std::string text = first_failure();
  if (text.empty()) return "GDAL gives no reason";
  std::replace(text.begin(), text.end(), '\n', ' ');
  constexpr std::size_t kLongest = 200;  // GDAL quotes whole SQL statements
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

bool gdal_failed() { return !first_failure().empty(); }

}  // namespace spillway::formats
