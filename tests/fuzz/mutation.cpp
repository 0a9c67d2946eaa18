#include "tests/fuzz/mutation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace spillway::test {
namespace {

constexpr std::array<std::uint64_t, 12> kNumbers = {
    0,      1,          0x7f,       0x80,       0xff,       0x7fff,
    0xffff, 0x7fffffff, 0x80000000, 0xffffffff, 1ULL << 40, ~std::uint64_t{0}};

/// The text between the first and the last quote of a line, with its \xNN as bytes.
std::string unquoted(const std::string& line, std::size_t begin, std::size_t end) {
  std::string word;
  for (std::size_t i = begin; i < end; ++i) {
    if (line[i] != '\\') {
      word += line[i];
    } else if (line[i + 1] == 'x') {
      unsigned value = 0;
      std::from_chars(line.data() + i + 2, line.data() + i + 4, value, 16);
      word += static_cast<char>(value);
      i += 3;
    } else {
      word += line[++i];
    }
  }
  return word;
}

}  // namespace

std::string Mutation::input(std::uint64_t number) const {
  if (number < seeds_.size()) return seeds_[number];
  std::mt19937_64 random(number);
  std::string bytes = seeds_[random() % seeds_.size()];
  for (std::uint64_t changes = 1 + random() % 4; changes > 0; --changes) change(bytes, random);
  return bytes;
}

void Mutation::change(std::string& bytes, std::mt19937_64& random) const {
  const std::size_t at = random() % (bytes.size() + 1);
  const std::size_t left = bytes.size() - at;
  switch (random() % 7) {
    case 0:  // a bit
      if (left > 0) bytes[at] = static_cast<char>(bytes[at] ^ (1U << (random() % 8)));
      break;
    case 1:  // a byte
      if (left > 0) bytes[at] = static_cast<char>(random());
      break;
    case 2:  // the end is missing
      bytes.resize(at);
      break;
    case 3: {  // a number that is at some limit
      const std::uint64_t value = kNumbers[random() % kNumbers.size()];
      const std::size_t size = std::min<std::size_t>(left, std::size_t{1} << (random() % 4));
      if (size > 0) std::memcpy(&bytes[at], &value, size);
      break;
    }
    case 4:  // a word, before or over what is there
      if (words_.empty()) break;
      bytes.replace(at, random() % 2 == 0 ? 0 : std::min<std::size_t>(left, random() % 9),
                    words_[random() % words_.size()]);
      break;
    case 5: {  // part of another seed
      const std::string& other = seeds_[random() % seeds_.size()];
      const std::size_t from = random() % (other.size() + 1);
      bytes.replace(at, left, other, from, other.npos);
      break;
    }
    default:  // a part once more, or one less
      const std::string part = bytes.substr(at, random() % 64);
      if (random() % 2 == 0) {
        bytes.insert(at, part);
      } else {
        bytes.erase(at, part.size());
      }
  }
}

std::vector<std::string> dictionary_words(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("there is no dictionary " + path);
  std::vector<std::string> words;
  for (std::string line; std::getline(file, line);) {
    const std::size_t begin = line.find('"');
    const std::size_t end = line.rfind('"');
    if (line.empty() || line.front() == '#') continue;
    if (begin == line.npos || end == begin)
      throw std::runtime_error(fmt::format("{}: no word: {}", path, line));
    words.push_back(unquoted(line, begin + 1, end));
  }
  return words;
}

}  // namespace spillway::test
