#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace spillway::test {

/// Makes inputs of seeds, for builds without libFuzzer: the same ones each time.
class Mutation {
 public:
  /// `words` are texts that the format knows.
  Mutation(std::vector<std::string> seeds, std::vector<std::string> words)
      : seeds_(std::move(seeds)), words_(std::move(words)) {}

  /// The n-th input. The first ones are the seeds as they are.
  [[nodiscard]] std::string input(std::uint64_t number) const;

 private:
  void change(std::string& bytes, std::mt19937_64& random) const;

  std::vector<std::string> seeds_;
  std::vector<std::string> words_;
};

/// The words of a dictionary of libFuzzer. Throws std::runtime_error for a file that is none.
std::vector<std::string> dictionary_words(const std::string& path);

}  // namespace spillway::test
