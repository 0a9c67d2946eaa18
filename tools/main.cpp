#include "tools/program.h"

int main(int argc, char** argv) {
  return spillway::command::run_program(argc, argv, spillway::command::subcommands());
}
