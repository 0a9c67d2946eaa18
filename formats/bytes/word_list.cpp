#include "formats/bytes/word_list.h"

namespace spillway::formats {

std::string word_list(std::span<const std::string> words, std::string_view last) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool is_last = i + 1 == words.size();
    if (i > 0 && is_last) list.append(" ").append(last).append(" ");
    if (i > 0 && !is_last) list.append(", ");
    list.append(words[i]);
  }
  return list;
}

}  // namespace spillway::formats
