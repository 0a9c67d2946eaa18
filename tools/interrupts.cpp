#include "tools/interrupts.h"

#include <signal.h>
#include <unistd.h>

#include <thread>

#include "formats/file_system.h"

namespace spillway {

void handle_interrupts() {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  sigset_t interrupts;
  sigemptyset(&interrupts);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&interrupts, number);
  pthread_sigmask(SIG_BLOCK, &interrupts, nullptr);
  std::thread([interrupts] {
    int number = 0;
    while (sigwait(&interrupts, &number) != 0) {
    }
    remove_unfinished_files();
    _exit(128 + number);
  }).detach();
}

}  // namespace spillway
