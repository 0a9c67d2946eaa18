// What people write: conditions, lists, jobs, values of options, tables with their options.

#include <algorithm>
#include <cmath>

#include "formats/bytes/json.h"
#include "formats/bytes/xml_scanner.h"
#include "formats/gdal/crs_text.h"
#include "formats/inputs/input_list.h"
#include "formats/inputs/open_points.h"
#include "src/runtime/memory_budget.h"
#include "stream/source/condition/condition.h"
#include "tests/faulty_file_system.h"
#include "tests/fuzz/target.h"
#include "tests/fuzz/zstd_window.h"
#include "tools/batch/job_list.h"
#include "tools/options/input_options.h"
#include "tools/options/table_options.h"

namespace spillway::test {
namespace {

void read_condition(std::string_view text) {
  const stream::Condition condition{std::string(text)};
  constexpr std::size_t kCount = 3;
  const std::vector<double> column = {0, -1.5, std::nan("")};
  const std::vector<std::vector<double>> columns(condition.names().size(), column);
  expect_kept(condition.holds(columns, kCount).size() == kCount, "each point has an answer");
}

void read_list(std::string_view text) {
  FaultyFileSystem files;
  files.files["list"] = text;
  for (const std::string& name : names_in_list(*files.open("list"))) {
    expect_kept(!name.empty() && name.front() != '#', "names are no comments");
  }
}

void read_jobs(const std::string& path, std::string_view text) {
  FaultyFileSystem files;
  files.files[path] = text;
  for (const command::Job& job : command::read_job_list(files, path, {"ply"}, {})) {
    expect_kept(!job.name.empty() && !job.inputs.empty() && !job.to.empty(),
                "jobs have names, inputs and outputs");
  }
}

/// The first letter tells the option.
void read_value(std::string_view text) {
  if (text.empty()) return;
  const std::string_view value = text.substr(1);
  TextTable table;
  switch (text.front()) {
    case 'b':
      command::parse_bounds(value);
      break;
    case 'c':
      command::parse_classes(value);
      break;
    case 'd':
      command::parse_decimal(value);
      break;
    case 'k':
      command::parse_columns(value, table);
      break;
    case 'm':
      parse_memory_size(std::string(value));
      break;
    case 'r':
      command::parse_returns(value);
      break;
    case 's':
      command::parse_separator(value);
      break;
    case 't':
      command::parse_thinning(value);
      break;
    case 'z':
      command::parse_z_range(value);
      break;
    default:
      break;
  }
}

/// Three bytes are the options, the first line names columns, the rest is the table.
void read_table(std::string_view bytes) {
  constexpr std::string_view kSeparators("\0,;\t ", 5);
  constexpr std::string_view kDecimals("\0.,", 3);
  if (bytes.size() < 3 || has_large_zstd_window(bytes)) return;
  const auto option = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  PointReaderOptions options;
  options.format = "text";
  options.text.separator = kSeparators[option(0) % kSeparators.size()];
  options.text.decimal = kDecimals[option(1) % kDecimals.size()];
  options.text.no_header = option(2) % 2 == 1;
  options.text.skip_lines = option(2) / 2 % 4;
  options.skip_invalid = option(2) >= 128;
  bytes.remove_prefix(3);
  const std::string_view line = bytes.substr(0, bytes.find('\n'));
  TextTable table;
  if (!line.empty()) command::parse_columns(line, table);
  options.text.names = table.column_names;
  if (table.columns.size() >= 2) {
    const int z = table.columns.size() > 2 ? table.columns[2] : 0;
    options.text.columns = {table.columns[0] - 1, table.columns[1] - 1, z - 1};
  }
  for (const auto& [first, last] : table.characters) {
    options.text.characters.push_back({std::size_t(first) - 1, std::size_t(last)});
  }
  FaultyFileSystem files;
  files.files["a.txt"] = bytes.substr(std::min(bytes.size(), line.size() + 1));
  const auto reader = open_point_reader(files, "a.txt", options);
  PointBlock block;
  while (reader->read(block)) {
    for (const LatticePoint& point : block.points) {
      for (int k = 0; k < 3; ++k) expect_kept(std::isfinite(point[k]), "coordinates are finite");
    }
  }
}

void read_json(std::string_view text) {
  const Json json = parse_json(text);
  expect_kept(parse_json(json_to_text(json)) == json, "JSON comes back from its text");
}

void read_xml(std::string_view text) {
  XmlScanner scanner(text);
  XmlTag tag;
  std::size_t before = 0;
  while (scanner.next(tag) == XmlScanner::Result::kTag) {
    expect_kept(scanner.position() > before, "a scanner goes on");
    before = scanner.position();
    xml_unescaped(scanner.content());
  }
  expect_kept(xml_unescaped(xml_escaped(text)) == text, "text comes back from its entities");
}

void read_crs(std::string_view text) {
  looks_like_wkt(text);
  is_compound_wkt(text);
  may_tell_heights(text);
  name_in_wkt(text);
  units_in_wkt(text);
  looks_like_crs(text);
}

using Seeds = std::vector<std::string>;

Seeds condition_seeds() {
  return {"intensity > 200 and class in (2, 9)", "not (x < -1.5e3 or z >= y) and first",
          "return_number = return_count and single", "class not in (7, 18) or last"};
}

Seeds job_seeds() {
  return {R"({"to": ["ply", "dem.tif"], "options": {"memory": "1G", "quiet": true}, "buffer": 2.5,
"jobs": [{"in": ["a.las", "@list"], "name": "one"}, {"in": "b.laz", "to": "spm", "buffer": 0}]})"};
}

Seeds toml_job_seeds() {
  return {
      "to = [\"ply\"]\nbuffer = 3\n[options]\nmemory = '1G'\nquiet = true\n[[jobs]]\nname = "
      "\"a\"\nin = [\"a.las\"]\n[[jobs]]\nin = 'b.las'\noptions = { every = 2 }\n"};
}

Seeds value_seeds() {
  return {"b1,2,3.5,4e1", "b0,0,-1,1,1,1", "c2,3-5",      "dcomma", "kPNEZD",
          "k3,2,4",       "k1-10,11-20",   "kEast,North", "m512M",  "rfirst,2",
          "ssemicolon",   "t0.5:lowest",   "z-1,1e3"};
}

Seeds table_seeds() {
  using std::string_literals::operator""s;
  return {"\0\0\0\nx,y,z\n1,2,3\n4,5,6\n"s, "\2\2\0Hoch,Rechts\nHoch;Rechts\n1,5;2\n3;4,25\n"s,
          "\4\1\x81"
          "3,2,1\n1 2 3\nno point\n4 5 6\n"s,
          "\0\0\3"
          "1-3,4-6\n  1  2\n  3  4\n"s};
}

Seeds crs_seeds() {
  return {"EPSG:25832+5783", "+proj=utm +zone=32",
          "COMPD_CS[\"both\",PROJCS[\"UTM\",GEOGCS[\"WGS 84\"],UNIT[\"metre\",1]],VERT_CS[\"h\","
          "UNIT[\"foot\",0.3048]]]"};
}

}  // namespace

std::vector<FuzzTarget> text_targets() {
  return {
      {"condition", read_condition, condition_seeds},
      {"list", read_list, [] { return Seeds{"# of two\na.las\n\n  folder/*.laz \r\n"}; }},
      {"jobs-json", [](std::string_view text) { read_jobs("a.json", text); }, job_seeds},
      {"jobs-toml", [](std::string_view text) { read_jobs("a.toml", text); }, toml_job_seeds},
      {"option", read_value, value_seeds},
      {"table", read_table, table_seeds},
      {"json", read_json, [] { return Seeds{R"({"a": [1, -2.5e3, "t\u00e9", null, true]})"}; }},
      {"xml", read_xml,
       [] { return Seeds{"<?xml version=\"1.0\"?><!-- c --><a b=\"1\" c='&lt;'>t&#65;</a><d/>"}; }},
      {"crs", read_crs, crs_seeds}};
}

}  // namespace spillway::test
