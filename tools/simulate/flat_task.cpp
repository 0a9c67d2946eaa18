#include "tools/simulate/flat_task.h"

#include <algorithm>
#include <cmath>

namespace spillway::command {
namespace {

/// Whether no two things of it can run at the same time.
bool is_serial(const Task& task, bool with_children) {
  const auto all_serial = [](const std::vector<Task>& tasks) {
    return std::ranges::all_of(tasks, [](const Task& below) { return is_serial(below, true); });
  };
  if (task.grains > 1 || !all_serial(task.before) || !all_serial(task.after)) return false;
  return !with_children || (task.children.size() <= 1 && all_serial(task.children));
}

double seconds_of(const Task& task, bool with_children) {
  double sum = task.total_seconds();
  if (with_children) return sum;
  for (const Task& child : task.children) sum -= child.total_seconds();
  return sum;
}

void append(std::vector<FlatTask::Node>& nodes, const Task& task, double factor,
            bool with_children) {
  const std::size_t own = nodes.size();
  nodes.emplace_back();
  if (is_serial(task, with_children)) {
    nodes[own].seconds = static_cast<float>(factor * seconds_of(task, with_children));
  } else {
    nodes[own].seconds = static_cast<float>(factor * task.seconds);
    nodes[own].grains = static_cast<std::uint32_t>(task.grains);
    const auto append_all = [&](const std::vector<Task>& tasks) {
      for (const Task& below : tasks) append(nodes, below, factor, true);
      return static_cast<std::uint16_t>(tasks.size());
    };
    nodes[own].before = append_all(task.before);
    if (with_children) nodes[own].children = append_all(task.children);
    nodes[own].after = append_all(task.after);
  }
  nodes[own].end = static_cast<std::uint32_t>(nodes.size());
}

}  // namespace

double FlatTask::total_seconds() const {
  double sum = 0;
  for (const Node& node : nodes) sum += node.seconds;
  return sum;
}

FlatTask one_step(double seconds) { return {{{.seconds = static_cast<float>(seconds), .end = 1}}}; }

FlatTask flatten(const Task& task, double factor, bool with_children) {
  FlatTask flat;
  append(flat.nodes, task, factor, with_children);
  return flat;
}

FlatTask enlarge(const FlatTask& task, double factor) {
  FlatTask large = task;
  for (FlatTask::Node& node : large.nodes) {
    node.seconds = static_cast<float>(node.seconds * factor);
    if (node.grains > 1) node.grains = static_cast<std::uint32_t>(std::ceil(node.grains * factor));
  }
  return large;
}

}  // namespace spillway::command
