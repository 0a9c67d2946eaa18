#include "src/runtime/task.h"

namespace spillway::runtime {

double Task::total_seconds() const {
  double sum = seconds;
  for (const auto* steps : {&before, &children, &after}) {
    for (const Task& task : *steps) sum += task.total_seconds();
  }
  return sum;
}

}  // namespace spillway::runtime
