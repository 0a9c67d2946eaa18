#include "tools/report/task_json.h"

#include <vector>

namespace spillway::detail {
namespace {

Json to_json(const Task& task) {
  Json json = {{"kind", to_string(task.kind)},
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
  return {{"scope", to_string(sum.scope)}, {"level", sum.level},
          {"kind", to_string(sum.kind)},   {"tasks", sum.tasks},
          {"points", sum.points},          {"seconds", sum.seconds},
          {"pieces", sum.grains}};
}

}  // namespace spillway::detail
