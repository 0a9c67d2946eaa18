#include <spillway/error.h>

#include <string>
#include <utility>

#include "src/error.h"

namespace spillway {

const char* to_string(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kInvalidArgument:
      return "invalid argument";
    case ErrorCode::kDegenerateInput:
      return "degenerate input";
    case ErrorCode::kTooLarge:
      return "too large";
    case ErrorCode::kInterrupted:
      return "interrupted";
    case ErrorCode::kBadInput:
      return "bad input";
    case ErrorCode::kInputOutput:
      return "input or output";
    case ErrorCode::kOutOfBudget:
      return "out of budget";
    case ErrorCode::kClosedPipe:
      return "closed pipe";
  }
  return "unknown error";
}

const char* to_string(PlaceUnit unit) noexcept {
  switch (unit) {
    case PlaceUnit::kNone:
      return "";
    case PlaceUnit::kByte:
      return "byte";
    case PlaceUnit::kLine:
      return "line";
    case PlaceUnit::kRecord:
      return "record";
  }
  return "";
}

Error::Error(ErrorCode code, const std::string& message, ErrorFacts facts)
    : std::runtime_error(message), code_(code), facts_(std::move(facts)) {}

Error::~Error() = default;

}  // namespace spillway

namespace spillway::runtime {

std::string text_of(const FilePlace& place) {
  if (place.unit == PlaceUnit::kNone) return "";
  return to_string(place.unit) + (' ' + std::to_string(place.number));
}

std::string FileSpot::text() const {
  return place.unit == PlaceUnit::kNone ? file : file + ", " + text_of(place);
}

BadInput::BadInput(const std::string& file, const std::string& what, FilePlace place, Remedy remedy)
    : Failure(file + ": " + what, ErrorCode::kBadInput,
              {.file = file, .place = place, .remedy = remedy}) {}

BadInput::BadInput(const FileSpot& spot, const std::string& what)
    : Failure(spot.text() + ": " + what, ErrorCode::kBadInput,
              {.file = spot.file, .place = spot.place}) {}

BadInput BadInput::at(const std::string& file, FilePlace place, const std::string& what) {
  return {file, text_of(place) + ": " + what, place};
}

CannotWrite::CannotWrite(const std::string& file, const std::string& what, ErrorCode code,
                         FilePlace place, Remedy remedy)
    : Failure("cannot write " + file + ": " + what, code,
              {.file = file, .place = place, .remedy = remedy}) {}

}  // namespace spillway::runtime
