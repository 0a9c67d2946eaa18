#include "tools/process/standard_descriptors.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <initializer_list>

namespace spillway::command {

void open_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest free number, so this one. Open in the direction that is not wanted.
    const int direction = descriptor == STDIN_FILENO    ? O_WRONLY
                          : descriptor == STDOUT_FILENO ? O_RDONLY
                                                        : O_RDWR;
    int opened = ::open("/dev/null", direction);
    if (opened < 0) opened = ::open("/", O_RDONLY | O_DIRECTORY);  // nor can that be written to
    if (opened != descriptor) _exit(1);
  }
}

}  // namespace spillway::command
