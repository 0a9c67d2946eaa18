#include "tools/program.h"

int main(int argc, char** argv) {
  return spillway::detail::run_program(argc, argv, spillway::detail::subcommands());
}
