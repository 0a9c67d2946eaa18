#pragma once
// The LZ4 frame format (what the lz4 tool writes) as an input filter for Boost.Iostreams, which has
// none of its own.

#include <boost/iostreams/categories.hpp>
#include <boost/iostreams/read.hpp>
#include <cstddef>
#include <ios>
#include <memory>
#include <span>
#include <vector>

#include "formats/compression/lz4.h"

namespace spillway::formats {

/// The filter. Reading throws std::ios_base::failure if the data is corrupt or ends inside a frame.
class Lz4Decompressor {
 public:
  using char_type = char;
  using category = boost::iostreams::multichar_input_filter_tag;

  template <typename Source>
  std::streamsize read(Source& source, char* buffer, std::streamsize count) {
    State& state = *state_;
    const std::span<char> wanted(buffer, static_cast<std::size_t>(count));
    std::size_t done = 0;
    while (done < wanted.size()) {
      const auto [consumed, produced] = state.decoder.decode(
          std::span(state.compressed).subspan(state.begin, state.left), wanted.subspan(done));
      state.begin += consumed;
      state.left -= consumed;
      done += produced;
      if (consumed > 0 || produced > 0) continue;
      const std::streamsize got = boost::iostreams::read(
          source, state.compressed.data(), static_cast<std::streamsize>(state.compressed.size()));
      if (got <= 0) {
        if (!state.decoder.complete()) throw std::ios_base::failure("the LZ4 data ends early");
        break;
      }
      state.begin = 0;
      state.left = static_cast<std::size_t>(got);
    }
    return done == 0 && count > 0 ? -1 : static_cast<std::streamsize>(done);
  }

 private:
  static constexpr std::size_t kCompressedBuffer = std::size_t{128} << 10;

  struct State {
    Lz4FrameDecoder decoder;
    std::vector<char> compressed = std::vector<char>(kCompressedBuffer);
    std::size_t begin = 0;  // what is not decoded yet are `left` bytes from here
    std::size_t left = 0;
  };

  // Boost.Iostreams copies filters before it uses them.
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace spillway::formats
