#include "formats/meshes/sma/sma_format.h"

#include <utility>

#include "formats/meshes/sma/sma_reader.h"
#include "formats/meshes/sma/sma_writer.h"

namespace spillway::formats {
namespace {

constexpr std::string_view kExtensions[] = {"sma"};

}  // namespace

constinit const MeshFormat kSmaMesh = {
    .name = "sma",
    .title = "SMA",
    .extensions = kExtensions,
    .recognises = [](std::string_view text) { return text.starts_with(kSmaNote); },
    .resembles = looks_like_sma,
    .open_stream = open_sma_reader,
    .open_block_writer =
        [](MeshFiles files, const MeshStreamHeader& header) {
          return open_sma_writer(std::move(files.main), header);
        },
};

}  // namespace spillway::formats
