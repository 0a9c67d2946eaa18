// What the calls of a context share: inputs that were looked at, and the folder of scratch files.

#include "stream/library/context/context_state.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "formats/bytes/bytes.h"
#include "tests/error_facts.h"
#include "tests/formats/inputs/temporary_files.h"
#include "tests/stream/library/full_pipe.h"

namespace spillway::test {
namespace {

namespace fs = std::filesystem;

std::string all_of(InputFile& file) {
  std::string all;
  std::vector<std::byte> some(7);
  while (const std::size_t got = file.read(some)) all += as_text(std::span(some).first(got));
  return all;
}

TEST(ContextState, WhatALookHasReadOfAPipeIsNotLostToWhoeverOpensIt) {
  const FullPipe pipe("ply and what follows");
  ContextState state;
  EXPECT_EQ(as_text(state.input(pipe.path())->source().peek(3)), "ply");
  EXPECT_EQ(as_text(state.input(pipe.path())->source().peek(7)), "ply and") << "looked at again";
  EXPECT_EQ(all_of(*state.files().open(pipe.path())), "ply and what follows");
}

TEST(ContextState, APipeIsOneInputForAllCallsOfItsContextOnly) {
  const FullPipe pipe("bytes");
  ContextState state;
  EXPECT_EQ(state.input(pipe.path()), state.input(pipe.path()));
  EXPECT_EQ(state.input("-"), state.input("-")) << "standard input is a pipe whatever it is";
  EXPECT_NE(state.input(pipe.path()), state.input("-"));
  ContextState other;
  EXPECT_NE(state.input(pipe.path()), other.input(pipe.path()));
}

TEST(ContextState, AFileIsReadFromItsBeginningByEach) {
  const TemporaryFiles files;
  const std::string path = files.put("points.txt", "1 2 3\n");
  ContextState state;
  const auto first = state.input(path);
  EXPECT_NE(first, state.input(path));
  EXPECT_EQ(as_text(first->source().peek(5)), "1 2 3");
  EXPECT_EQ(all_of(*state.files().open(path)), "1 2 3\n");
  EXPECT_EQ(all_of(*state.files().open(path)), "1 2 3\n");
  EXPECT_NE(state.input(files.path("none")), state.input(files.path("none"))) << "may come yet";
}

/// A context whose scratch files go into that folder.
Context context_in(const std::string& folder, const std::string& limit = "") {
  ContextOptions options;
  options.scratch_folder = folder;
  options.scratch_limit = limit;
  return Context(options);
}

TEST(ContextState, MemoryIsANumberOrAText) {
  EXPECT_EQ(Context({.memory = 64 << 20}).memory(), 64U << 20);
  EXPECT_EQ(Context({.memory = std::uint64_t{1} << 33}).memory(), std::uint64_t{1} << 33);
  EXPECT_EQ(Context({.memory = "64M", .scratch_limit = 1000}).scratch_limit(), 1000U);
  EXPECT_EQ(Context({.memory = std::string("64M")}).memory(), 64U << 20);
  EXPECT_THROW(Context({.memory = -1}), Error);
  EXPECT_THROW(Context({.memory = 0}), Error);
}

TEST(ContextState, TheScratchFolderIsSharedAndGoesWithItsLastUser) {
  const TemporaryFiles files;
  fs::create_directory(files.path("scratch"));
  const Context context = context_in(files.path("scratch"));
  const Context copy = context;
  auto folder = context.state().scratch(context);
  auto same = copy.state().scratch(copy);
  EXPECT_EQ(folder, same);
  const auto file = folder->create("points");
  EXPECT_TRUE(file->name().starts_with(files.path("scratch")));
  EXPECT_FALSE(fs::is_empty(files.path("scratch")));
  folder.reset();
  EXPECT_FALSE(fs::is_empty(files.path("scratch"))) << "one uses it still";
  same.reset();
  EXPECT_TRUE(fs::is_empty(files.path("scratch")));

  const auto next = context.state().scratch(context);
  const auto next_file = next->create("points");
  EXPECT_FALSE(fs::is_empty(files.path("scratch"))) << "the next user has one again";
}

TEST(ContextState, ScratchFilesKeepToTheLimitOfTheirOwnContext) {
  const TemporaryFiles files;
  const Context narrow = context_in(files.path(""), "64K");
  const Context wide = context_in(files.path(""));
  const std::vector<std::byte> bytes(std::size_t{100} << 10);
  const auto narrow_folder = narrow.state().scratch(narrow);
  const auto wide_folder = wide.state().scratch(wide);
  EXPECT_NE(narrow_folder, wide_folder);
  const auto narrow_file = narrow_folder->create("points");
  const auto error = thrown_by([&] { narrow_file->append(bytes); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kOutOfBudget);
  EXPECT_EQ(error->facts().remedy, Remedy::kScratchLimit);
  const auto wide_file = wide_folder->create("points");
  wide_file->append(bytes);
  EXPECT_EQ(wide_file->size(), bytes.size());
}

}  // namespace
}  // namespace spillway::test
