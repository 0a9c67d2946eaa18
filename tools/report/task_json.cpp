#include "tools/report/task_json.h"

#include <vector>

namespace spillway::command {
namespace {

const char* name_of(TaskKind kind) {
  switch (kind) {
    case TaskKind::kNode:
      return "node";
    case TaskKind::kBaseCase:
      return "base_case";
    case TaskKind::kDivide:
      return "divide";
    case TaskKind::kBorder:
      return "border";
    case TaskKind::kAccept:
      return "accept";
    case TaskKind::kNeighbours:
      return "neighbours";
  }
  return "";
}

const char* name_of(TaskScope scope) {
  switch (scope) {
    case TaskScope::kInTile:
      return "in_tile";
    case TaskScope::kBetweenTiles:
      return "between_tiles";
    case TaskScope::kBetweenRanks:
      return "between_ranks";
  }
  return "";
}

Json to_json(const Task& task) {
  Json json = {{"kind", name_of(task.kind)},
               {"points", task.points},
               {"seconds", task.seconds},
               {"pieces", task.grains}};
  const auto add_list = [&json](const char* key, const std::vector<Task>& tasks) {
    if (tasks.empty()) return;
    json[key] = Json::array();
    for (const Task& below : tasks) json[key].push_back(to_json(below));
  };
  add_list("before", task.before);
  add_list("children", task.children);
  add_list("after", task.after);
  return json;
}

}  // namespace

Json to_json(const TaskNode& node) {
  return {{"number", node.number},
          {"level", node.level},
          {"below", node.children},
          {"task", to_json(node.task)}};
}

Json to_json(const TaskSum& sum) {
  return {{"scope", name_of(sum.scope)}, {"level", sum.level},   {"kind", name_of(sum.kind)},
          {"tasks", sum.tasks},          {"points", sum.points}, {"seconds", sum.seconds},
          {"pieces", sum.grains}};
}

}  // namespace spillway::command
