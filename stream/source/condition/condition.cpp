#include "stream/source/condition/condition.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "stream/source/condition/condition_parser.h"

namespace spillway::stream {

Condition::Condition(const std::string& text) : text_(text) {
  ConditionParser parser(text);
  root_ = parser.parse();
  names_ = parser.names();
}

std::vector<bool> Condition::holds(std::span<const std::vector<double>> columns,
                                   std::size_t count) const {
  std::vector<bool> all(count);
  std::vector<double> numbers(columns.size());
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) numbers[c] = columns[c][i];
    all[i] = root_->holds(numbers);
  }
  return all;
}

}  // namespace spillway::stream
