#include "tools/commands/skipped_inputs.h"

#include <fmt/format.h>

#include "tools/process/exit_code.h"

namespace spillway::command {

int tell_skipped(const std::vector<SkippedFile>& files, ProgressLine& progress) {
  if (files.empty()) return kExitDone;
  for (const SkippedFile& file : files) progress.insist("error: " + file.message);
  progress.insist(files.size() == 1
                      ? std::string("this input is left out; the output is complete without it")
                      : fmt::format("these {} inputs are left out; the output is complete without "
                                    "them",
                                    files.size()));
  return kExitFailed;
}

}  // namespace spillway::command
