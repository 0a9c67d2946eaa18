#pragma once

#include <spillway/skipped_file.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "formats/disk/file_system.h"
#include "formats/points/common/point_reader.h"
#include "stream/source/input_crs.h"
#include "stream/source/point_filter.h"
#include "stream/source/source_facts.h"
#include "stream/source/transformed_points.h"

namespace spillway::stream {

struct HeaderSurveyOptions {
  int dimension = 2;  ///< 0: any
  PointReaderOptions reader{};
  PointFilter filter{};  ///< says what inputs must have
  CrsChoice crs{};
  PointTransform transform{};  ///< of all inputs
  bool skip_broken = false;  ///< leave out files that cannot be opened, or whose headers are broken
  bool digests = false;      ///< facts have digests of files
  /// Receives what is worth a warning, and what only -v shows.
  std::function<void(std::string_view)> warn = [](std::string_view) {};
  std::function<void(std::string_view)> detail = [](std::string_view) {};
};

/// What the headers of all inputs say.
struct HeaderSurvey {
  SourceFacts facts;
  /// One an input: the reader of what opens just once, as nobody else can have it, and else null.
  std::vector<std::shared_ptr<PointReader>> readers;
  std::vector<std::string> paths{};    ///< of the inputs
  std::vector<SkippedFile> skipped{};  ///< files that were left out
};

/// What is told of an input of that name, and perhaps of `more` ones.
std::string notice_of_input(const std::string& name, std::string_view text,
                            std::string_view more = {});

/// Looks at the headers of all inputs. Throws Failure that names all inputs that cannot be opened or
/// do not have what the dimension and the filter need, or two of different coordinate systems. With
/// `skip_broken`, inputs that cannot be opened are an error only if there are no others.
HeaderSurvey survey_headers(FileSystem& files, const std::vector<std::string>& paths,
                            const HeaderSurveyOptions& options);

}  // namespace spillway::stream
