#pragma once
// All that the command writes to standard error goes through here.

#include <string_view>

#include "src/rooms.h"

namespace spillway::command {

/// How a run speaks to standard error.
enum class MessageStyle {
  kText,      ///< lines for people
  kTerminal,  ///< likewise, below a line that is rewritten
  kJson,      ///< a JSON object a line
};

/// Sets how last_message() speaks.
void set_message_style(MessageStyle style);

/// Writes text as it is, in one piece. What standard error does not take is lost: it is not worth
/// failing for.
void write_to_standard_error(std::string_view text);

/// A line "spillway: error: " and the message, with its control characters escaped.
void write_error(std::string_view message);

/// The same with "warning", for what comes after all else.
void write_warning(std::string_view message);

/// A message, also escaped, as the style wants it, over a line that is being rewritten; all that is
/// written later is lost. Gives up where standard error takes nothing: it never waits long. For the
/// end of the run by a signal.
void last_message(std::string_view message);

}  // namespace spillway::command
