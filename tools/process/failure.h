#pragma once
// How a run ends that went wrong: one line on standard error, and an exit code.

#include <exception>
#include <string>

#include "src/rooms.h"

namespace spillway::command {

/// Reports what was thrown and ends the ranks, if there are any (rank_job.h). Returns the exit code
/// for main; in a second thread that fails, not at all: one line is enough. A thread that cannot be
/// started, and memory that cannot be had, are told as such, with the limits of this process that
/// are in the way.
int report_failure(const std::exception_ptr& failure) noexcept;

/// What an exception says; of memory and threads that cannot be had with the limits that are in the
/// way, as report_failure() has them.
std::string words_of(const std::exception& error);

/// Makes an exception that nobody catches, as in a thread of a library, end the run as
/// report_failure() would, with nothing left behind.
void handle_uncaught_exceptions();

/// Words for the temporary files and folders that could not be removed; "" if there are none.
std::string temporary_paths_left_in_words();

/// Warns of them, for the end of main.
void tell_of_temporary_paths_left() noexcept;

}  // namespace spillway::command
