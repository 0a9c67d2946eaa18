// What errors say and the facts that go with them: callers word their advice by these.

#include "src/error.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <set>
#include <string>

namespace spillway::test {
namespace {

TEST(ErrorNames, EveryCodeHasOneOfItsOwn) {
  std::set<std::string> names;
  for (int code = 1; code <= 8; ++code) names.insert(to_string(static_cast<ErrorCode>(code)));
  EXPECT_EQ(names.size(), 8U);
  EXPECT_EQ(names.count("unknown error"), 0U);
  EXPECT_STREQ(to_string(static_cast<ErrorCode>(9)), "unknown error");
}

TEST(ErrorNames, NumbersOfCodesStayWhatTheyAre) {
  EXPECT_EQ(static_cast<int>(ErrorCode::kInvalidArgument), 1);
  EXPECT_EQ(static_cast<int>(ErrorCode::kBadInput), 5);
  EXPECT_EQ(static_cast<int>(ErrorCode::kClosedPipe), 8);
}

TEST(FilePlaces, AreWrittenWithTheirUnit) {
  EXPECT_EQ(text_of(at_byte(0)), "byte 0");
  EXPECT_EQ(text_of(at_line(7)), "line 7");
  EXPECT_EQ(text_of(at_record(12)), "record 12");
  EXPECT_EQ(text_of({}), "");
  EXPECT_EQ((FileSpot{"points.spp", at_byte(4096)}.text()), "points.spp, byte 4096");
  EXPECT_EQ((FileSpot{"points.spp"}.text()), "points.spp");
}

TEST(BadInputError, NamesFileAndPlaceInTheTextAndInTheFacts) {
  const auto expect = [](const Failure& error, const std::string& text, PlaceUnit unit) {
    EXPECT_EQ(error.what(), text);
    EXPECT_EQ(error.code(), ErrorCode::kBadInput);
    EXPECT_EQ(error.facts().file, "a.las");
    EXPECT_EQ(error.facts().place.unit, unit);
    EXPECT_EQ(error.facts().place.number, unit == PlaceUnit::kNone ? 0U : 9U);
  };
  expect(BadInput("a.las", "ends early"), "a.las: ends early", PlaceUnit::kNone);
  expect(BadInput("a.las", "ends at byte 9", at_byte(9)), "a.las: ends at byte 9",
         PlaceUnit::kByte);
  expect(BadInput(FileSpot{"a.las", at_byte(9)}, "ends"), "a.las, byte 9: ends", PlaceUnit::kByte);
  expect(BadInput::at("a.las", at_line(9), "no number"), "a.las: line 9: no number",
         PlaceUnit::kLine);
  EXPECT_EQ(BadInput("a.las", "is cut off", {}, Remedy::kSalvage).facts().remedy, Remedy::kSalvage);
}

TEST(CannotWriteError, SaysWhatWasToBeWritten) {
  const CannotWrite error("b.ply", "vertex 3 is infinite", ErrorCode::kTooLarge, at_record(3),
                          Remedy::kOneFile);
  EXPECT_STREQ(error.what(), "cannot write b.ply: vertex 3 is infinite");
  EXPECT_EQ(error.code(), ErrorCode::kTooLarge);
  EXPECT_EQ(error.facts().file, "b.ply");
  EXPECT_EQ(error.facts().place.number, 3U);
  EXPECT_EQ(error.facts().remedy, Remedy::kOneFile);
  EXPECT_EQ(CannotWrite("b.ply", "too few").code(), ErrorCode::kInvalidArgument);
}

TEST(ErrorListError, HasALineForEachFaultAndTheFactsOfTheFirst) {
  const ErrorList list("2 inputs are at fault",
                       {BadInput("a.las", "ends early", at_byte(9), Remedy::kSalvage),
                        SystemRefusal("cannot read b.las: no such file", "b.las", ENOENT)});
  EXPECT_STREQ(list.what(),
               "2 inputs are at fault:\n  a.las: ends early\n  cannot read b.las: no such file");
  EXPECT_EQ(list.code(), ErrorCode::kBadInput);
  EXPECT_EQ(list.facts().file, "a.las");
  EXPECT_EQ(list.facts().remedy, Remedy::kSalvage);
  EXPECT_EQ(list.heading(), "2 inputs are at fault");
  ASSERT_EQ(list.faults().size(), 2U);
  EXPECT_EQ(list.faults()[1].code(), ErrorCode::kInputOutput);
  EXPECT_EQ(list.faults()[1].facts().system_error, ENOENT);
}

TEST(ErrorKinds, HaveTheCodesThatCallersActBy) {
  EXPECT_EQ(InvalidArgument("x").code(), ErrorCode::kInvalidArgument);
  EXPECT_EQ(TooSmallLimit("x", {.enough = 7}).code(), ErrorCode::kOutOfBudget);
  EXPECT_EQ(TooSmallLimit("x", {.enough = 7}).facts().enough, 7U);
  EXPECT_EQ(Interrupted().code(), ErrorCode::kInterrupted);
  EXPECT_EQ(ClosedPipe().code(), ErrorCode::kClosedPipe);
}

}  // namespace
}  // namespace spillway::test
