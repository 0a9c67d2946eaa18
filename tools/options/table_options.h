#pragma once
// How a table of text is written, where the user says it.

#include <spillway/points.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "tools/options/command_line.h"

namespace spillway::command {

/// As on the command line; an empty text is an option that was not given.
struct TableOptions {
  std::string columns;
  std::uint64_t skip_lines = 0;
  std::string separator;
  std::string decimal;
  bool no_header = false;
};

/// --columns, --skip-lines, --separator, --decimal and --no-header.
void add_table_options(CommandLine& app, TableOptions& options);

/// The same for PointOptions. Throws UsageError that says what is expected.
TextTable text_table(const TableOptions& options);

/// Reads the value of --columns: for x, y and, maybe, z
/// - numbers of columns, "3,2,4";
/// - characters of each line, "1-10,11-20,21-28";
/// - names, "Easting,Northing,Height";
/// - or a letter for each column from the first on, "PNEZD", of which X or E, Y or N, and Z or H
///   count.
/// Sets the one member that this is. Throws UsageError for anything else.
void parse_columns(std::string_view text, TextTable& table);

/// Read the values of --separator and --decimal: a sign, or its name. Throw UsageError.
char parse_separator(std::string_view text);
char parse_decimal(std::string_view text);

}  // namespace spillway::command
