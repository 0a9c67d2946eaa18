#include "formats/pages/relief_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "formats/bytes/bytes.h"
#include "formats/bytes/json.h"
#include "formats/pages/base64.h"
#include "formats/pages/relief_html.h"

namespace spillway::formats {
namespace {

/// Text as it stands between tags.
std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

/// JSON as it stands in a script: no tag can end it.
std::string in_script(const Json& json) {
  std::string safe;
  for (const char c : json_to_text(json)) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string css_colour(std::uint32_t colour) { return fmt::format("#{:06x}", colour); }

Json ramps_of(const ReliefPage& page) {
  Json ramps = Json::object();
  for (const PageRamp& ramp : page.ramps) {
    std::vector<std::string> colours;
    for (const std::uint32_t colour : ramp.colours) colours.push_back(css_colour(colour));
    ramps[ramp.name] = colours;
  }
  return ramps;
}

Json own_colours_of(const PageColours& own) {
  if (own.name.empty()) return {};
  Json entries = Json::array();
  for (const PageColours::Entry& entry : own.entries) {
    entries.push_back({{"text", entry.text}, {"colour", css_colour(entry.colour)}});
  }
  return {{"name", own.name}, {"facts", own.facts}, {"entries", entries}};
}

/// All but what each node has.
Json relief_of(const ReliefPage& page) {
  return {{"facts", page.facts},
          {"columns", page.columns},
          {"rows", page.rows},
          {"side", page.side},
          {"lowest", page.lowest},
          {"highest", page.highest},
          {"range", page.colour_range},
          {"exaggeration", page.exaggeration},
          {"view", page.view},
          {"light", page.light},
          {"ramps", ramps_of(page)},
          {"ramp", page.ramp},
          {"own", own_colours_of(page.own)}};
}

/// What is encoded at a time, in bytes: groups of three.
constexpr std::size_t kPiece = std::size_t{3} << 18;

/// A page that is being written.
class PageOutput {
 public:
  PageOutput(FileSystem& files, const std::string& path) : file_(files.create(path)) {}

  void write(std::string_view text) {
    file_->write(as_bytes_of(text));
    bytes_ += text.size();
  }

  /// Writes a further member of an object that is open.
  void write_member(std::string_view name, std::span<const std::byte> bytes) {
    write(fmt::format(",\"{}\":\"", name));
    for (std::size_t i = 0; i < bytes.size(); i += kPiece) {
      write(to_base64(bytes.subspan(i, std::min(kPiece, bytes.size() - i))));
    }
    write("\"");
  }

  std::uint64_t commit() {
    file_->commit();
    return bytes_;
  }

 private:
  std::unique_ptr<OutputFile> file_;
  std::uint64_t bytes_ = 0;
};

}  // namespace

std::uint64_t write_relief_page(FileSystem& files, const std::string& path,
                                const ReliefPage& page) {
  PageOutput output(files, path);
  std::string_view rest = relief_html();
  const auto write_until = [&](std::string_view mark) {
    const std::size_t place = rest.find(mark);
    output.write(rest.substr(0, place));
    rest.remove_prefix(place + mark.size());
  };
  write_until("{{title}}");
  output.write(escaped(page.title));
  write_until("{{relief}}");
  std::string relief = in_script(relief_of(page));
  relief.pop_back();  // its object goes on
  output.write(relief);
  output.write_member("heights", std::as_bytes(page.heights));
  if (!page.own.name.empty()) output.write_member("tints", std::as_bytes(page.own.nodes));
  output.write("}");
  output.write(rest);
  return output.commit();
}

}  // namespace spillway::formats
