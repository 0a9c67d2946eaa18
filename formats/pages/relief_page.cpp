#include "formats/pages/relief_page.h"

#include <fmt/format.h>

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
  return {{"name", own.name},
          {"facts", own.facts},
          {"entries", entries},
          {"nodes", to_base64(std::as_bytes(own.nodes))}};
}

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
          {"own", own_colours_of(page.own)},
          {"heights", to_base64(std::as_bytes(page.heights))}};
}

}  // namespace

std::uint64_t write_relief_page(FileSystem& files, const std::string& path,
                                const ReliefPage& page) {
  const auto file = files.create(path);
  std::uint64_t bytes = 0;
  const auto write = [&](std::string_view text) {
    file->write(as_bytes_of(text));
    bytes += text.size();
  };
  std::string_view rest = relief_html();
  const auto write_until = [&](std::string_view mark) {
    const std::size_t place = rest.find(mark);
    write(rest.substr(0, place));
    rest.remove_prefix(place + mark.size());
  };
  write_until("{{title}}");
  write(escaped(page.title));
  write_until("{{relief}}");
  write(in_script(relief_of(page)));
  write(rest);
  file->commit();
  return bytes;
}

}  // namespace spillway::formats
