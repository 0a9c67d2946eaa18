#include "formats/point_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "formats/bytes.h"
#include "formats/decompress.h"
#include "formats/glb_format.h"
#include "formats/input_source.h"
#include "formats/las_reader.h"
#include "formats/npy_header.h"
#include "formats/npy_mesh.h"
#include "formats/npy_reader.h"
#include "formats/point_format.h"
#include "formats/sma_reader.h"
#include "formats/spm_format.h"
#include "formats/spp_format.h"
#include "formats/spp_reader.h"
#include "formats/text_reader.h"
#include "src/error.h"

namespace spillway {
namespace {

constexpr std::size_t kProbe = 512;

/// Whether these bytes may begin a text file: no control characters but white space.
bool looks_like_text(std::string_view bytes) {
  return std::none_of(bytes.begin(), bytes.end(), [](unsigned char c) {
    return c == 0x7f || (c < ' ' && c != '\t' && c != '\n' && c != '\r' && c != '\f');
  });
}

/// Throws Error if these bytes begin a mesh of a format that is known by them.
void refuse_mesh(const InputSource& source, std::string_view text) {
  struct Known {
    std::string_view begin;
    std::string_view name;
  };
  constexpr std::array kKnown = {Known{"ply\n", "PLY"},    Known{"ply\r", "PLY"},
                                 Known{"OFF\n", "OFF"},    Known{kSpmMagic, "spm"},
                                 Known{kSmaNote, "sma"},   Known{glb::kMagic, "glTF"},
                                 Known{"<VTKFile", "VTU"}, Known{"<?xml", "XML"},
                                 Known{"solid ", "STL"},   Known{"# spillway dimension", "OBJ"}};
  for (const Known& known : kKnown) {
    if (!text.starts_with(known.begin)) continue;
    throw Error(fmt::format(
        "{}: this is a mesh ({}), not points; give the points it was made of, as LAS, text, npy or "
        "spp{}",
        source.name(), known.name,
        source.size() ? "" : "; of meshes only spm and sma are read from a pipe"));
  }
}

PointFormat format_of_content(const InputSource& source, std::span<const std::byte> first_bytes) {
  const std::string_view text = as_text(first_bytes);
  if (text.starts_with("LASF")) return PointFormat::kLas;
  if (text.starts_with(kNpyMagic)) return PointFormat::kNpy;
  if (text.starts_with(kSppMagic)) return PointFormat::kSpp;
  if (compression_of_content(first_bytes) != Compression::kNone) return PointFormat::kText;
  if (looks_like_text(text)) return PointFormat::kText;
  throw Error(
      fmt::format("{}: unknown format: the file begins neither as LAS nor as npy nor as "
                  "spp nor as text; convert it or name its format",
                  source.name()));
}

/// How the text is compressed, by its name or its first bytes.
Compression compression_of(const InputSource& source, const std::string& path,
                           std::span<const std::byte> first_bytes) {
  const Compression promised = compression_of_name(path);
  const Compression found = compression_of_content(first_bytes);
  if (promised != Compression::kNone) {
    const std::string inner = extension_of(std::filesystem::path(path).stem().string());
    if (inner == "las" || inner == "laz" || inner == "npy" || inner == "spp") {
      throw Error(fmt::format("{}: only text is read compressed; decompress the file first",
                              source.name()));
    }
    if (found != promised) {
      throw Error(
          fmt::format("{}: the file does not begin as its extension says; it is corrupt or "
                      "has the wrong name",
                      source.name()));
    }
  }
  return found;
}

}  // namespace

void PointReader::decode(RawPoints& raw, PointBlock& block) const { std::swap(raw.decoded, block); }

void PointReader::begin_piece(std::uint64_t piece) {
  const std::uint64_t count = pieces().value_or(0);
  if (piece >= count) {
    throw Error(fmt::format("{}: there is no piece {} of {}; read it from front to back",
                            header().name, piece, count));
  }
  go_to_piece(piece);
}

bool PointReader::read(PointBlock& block) {
  RawPoints raw;
  std::uint64_t withheld = 0;
  block.clear();
  while (block.size() == 0 && fetch(raw)) {
    decode(raw, block);
    raw.clear();
    withheld += std::exchange(block.withheld, 0);
  }
  block.withheld = withheld;
  return block.size() > 0;
}

std::unique_ptr<PointReader> open_point_reader(FileSystem& files, const std::string& path,
                                               const PointReaderOptions& options) {
  std::optional<PointFormat> format;
  if (!options.format.empty()) format = point_format_by_name(options.format);
  if (!format) format = point_format_of_path(path);
  auto source = std::make_unique<InputSource>(files.open(path));
  if (path == "-") source->check_not_empty();
  const std::span<const std::byte> first_bytes = source->peek(kProbe);
  if (!format || format == PointFormat::kText) refuse_mesh(*source, as_text(first_bytes));
  if (!format) format = format_of_content(*source, first_bytes);
  switch (*format) {
    case PointFormat::kLas:
      return open_las_reader(std::move(source), path, options);
    case PointFormat::kNpy:
      if (path.ends_with(kNpySimplices) && is_part_of_npy_mesh(files, path)) {
        throw Error(fmt::format(
            "{}: these are the simplices of an npy mesh, not points; its vertices are in a file "
            "beside it",
            path));
      }
      return open_npy_reader(std::move(source), path);
    case PointFormat::kSpp:
      return open_spp_reader(std::move(source), path);
    case PointFormat::kText:
      break;
  }
  const Compression compression = compression_of(*source, path, first_bytes);
  return open_text_reader(std::move(source), path, compression);
}

}  // namespace spillway
