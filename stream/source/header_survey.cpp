#include "stream/source/header_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/inputs/open_points.h"
#include "formats/points/attributes/further_coordinates.h"
#include "src/error.h"
#include "stream/source/changed_input.h"
#include "stream/source/source_crs.h"

namespace spillway::stream {
namespace {

/// "; they have intensity, classification", or nothing.
std::string names_of(const AttributeLayout& attributes) {
  std::string names;
  for (const AttributeField& field : attributes.fields()) {
    names += (names.empty() ? "; they have " : ", ") + field.attribute.name;
  }
  return names;
}

/// Throws Failure unless the points have what the dimension and the filter need.
void check_points_have(const SourceFacts::Input& input, const HeaderSurveyOptions& options) {
  const PointHeader& header = input.header;
  if (options.dimension >= 3 && !input.has_heights()) {
    throw Failure(header.name + ": the points have no z", ErrorCode::kDegenerateInput,
                  {.file = header.name, .remedy = Remedy::kPlane});
  }
  for (int axis = kOwnAxes; axis < options.dimension; ++axis) {
    if (find_coordinate(header.attributes, axis) != nullptr) continue;
    throw Failure(
        fmt::format("{}: the points have no coordinate {} of {} dimensions: no attribute called "
                    "{} (of arrays without names: {}){}",
                    header.name, axis + 1, options.dimension, coordinate_name(axis),
                    column_name(axis), names_of(header.attributes)),
        ErrorCode::kBadInput, {.file = header.name});
  }
  for (const std::string& name : options.filter.attributes()) {
    if (header.attributes.find(name) != nullptr) continue;
    throw Failure(fmt::format("{}: the points have no {}, which a filter looks at{}", header.name,
                              name, names_of(header.attributes)),
                  ErrorCode::kBadInput, {.file = header.name, .remedy = Remedy::kFilters});
  }
}

/// What has been met that many inputs tell alike, so that it is kept once.
struct Known {
  std::map<std::string_view, SharedText> texts;  ///< of coordinate systems
  /// What inputs are transformed from, by what their headers tell: text and GeoTIFF keys.
  std::map<std::pair<std::string, std::string>, std::string> transformed_from;
  AttributeLayout attributes;  ///< of the input before
};

/// What reading the header of an input gave.
struct Surveyed {
  std::shared_ptr<PointReader> reader;
  SourceFacts::Input input;
};

/// As system_to_transform(), which takes longer than to read a small file.
std::string known_system_to_transform(const PointHeader& header, const HeaderSurveyOptions& options,
                                      Known& known) {
  std::pair key(header.crs.text(), std::string(as_text(header.crs_keys.directory)));
  const auto found = known.transformed_from.find(key);
  if (found != known.transformed_from.end()) return found->second;
  std::string from = system_to_transform(header, options.crs, options.transform, options.warn);
  return known.transformed_from.emplace(std::move(key), std::move(from)).first->second;
}

Surveyed survey(FileSystem& files, const std::string& path, const HeaderSurveyOptions& options,
                Known& known) {
  Surveyed all;
  auto reader = open_point_reader(files, path, options.reader);
  if (options.transform.changes_plane()) {
    all.input.transformed_from = known_system_to_transform(reader->header(), options, known);
  }
  all.reader = transformed(std::move(reader), all.input.transformed_from, options.transform,
                           options.reader.skip_invalid);
  all.input.header = all.reader->header();
  std::error_code unknown;
  SourceFacts::Input& input = all.input;
  input.bytes = bytes_of_file(path);
  input.opens_once = path == "-" || !std::filesystem::is_regular_file(path, unknown);
  // The n-th records of an input can be told in its pieces only if these know what comes before.
  if (!input.opens_once && (options.filter.every == 1 || input.header.count)) {
    input.pieces = all.reader->pieces();
  }
  if (options.digests && !input.opens_once) input.digest = digest_of(*files.open(path));
  if (!input.opens_once) all.reader.reset();
  return all;
}

/// Whether an error is of the file, and not of how the library was called or of the run.
bool is_of_file(const Failure& error) {
  return error.code() == ErrorCode::kBadInput || error.code() == ErrorCode::kInputOutput;
}

/// Says once what holds for many inputs.
void tell_notices(const SourceFacts& facts, const HeaderSurveyOptions& options) {
  struct Notice {
    const std::string* text;
    const std::string* first;
    std::size_t count;
  };
  static const std::string no_heights =
      "the points have no z, beside others that have: it is 0 there";
  std::vector<Notice> notices;
  const auto add = [&](const PointHeader& header, const std::string& text) {
    const auto known =
        std::ranges::find_if(notices, [&](const Notice& notice) { return *notice.text == text; });
    if (known == notices.end()) {
      notices.push_back({&text, &header.name, 1});
    } else {
      ++known->count;
    }
  };
  const bool heights = facts.has_heights();
  for (const SourceFacts::Input& input : facts.inputs) {
    for (const std::string& text : input.header.notices) add(input.header, text);
    if (heights && !input.has_heights()) add(input.header, no_heights);
  }
  for (const Notice& notice : notices) {
    const std::string more =
        notice.count > 1 ? fmt::format(" (and {} more)", notice.count - 1) : std::string();
    options.warn(notice_of_input(*notice.first, *notice.text, more));
  }
}

}  // namespace

std::string notice_of_input(const std::string& name, std::string_view text, std::string_view more) {
  return fmt::format("{}{}: {}", name == "-" ? "standard input" : name, more, text);
}

HeaderSurvey survey_headers(FileSystem& files, const std::vector<std::string>& paths,
                            const HeaderSurveyOptions& options) {
  HeaderSurvey all;
  Known known;
  std::vector<Failure> faults;
  std::vector<Failure> broken;
  for (const std::string& path : paths) {
    Surveyed one;
    try {
      one = survey(files, path, options, known);
    } catch (const InvalidArgument&) {
      throw;
    } catch (const Failure& error) {
      const bool skipped = options.skip_broken && is_of_file(error);
      (skipped ? broken : faults).push_back(error);
      if (skipped) all.skipped.push_back({path, error.what()});
      continue;
    }
    try {
      check_points_have(one.input, options);
    } catch (const Failure& error) {
      faults.push_back(error);
      continue;
    }
    SharedText& crs = one.input.header.crs;
    crs = known.texts.emplace(crs, crs).first->second;
    AttributeLayout& attributes = one.input.header.attributes;
    if (attributes == known.attributes) attributes = known.attributes;
    known.attributes = attributes;
    all.readers.push_back(std::move(one.reader));
    all.facts.inputs.push_back(std::move(one.input));
    all.paths.push_back(path);
  }
  if (all.paths.empty() && faults.empty()) faults = std::move(broken);
  if (faults.size() == 1) throw Failure(faults.front());
  if (!faults.empty()) {
    const std::size_t count = faults.size();
    throw ErrorList(fmt::format("{} of {} inputs cannot be read", count, paths.size()),
                    std::move(faults));
  }
  tell_notices(all.facts, options);
  const CrsChoice choice = options.transform.changes_plane() ? CrsChoice{} : options.crs;
  all.facts.crs = find_crs(all.facts, {choice, options.warn, options.detail});
  return all;
}

}  // namespace spillway::stream
