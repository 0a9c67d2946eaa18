#include "tools/report/text_output.h"

#include <span>

#include "formats/disk/file_system.h"

namespace spillway::command {

void write_text(const std::string& path, std::string_view text) {
  const auto output = disk().create(path);
  output->write(std::as_bytes(std::span(text)));
  output->commit();
}

}  // namespace spillway::command
