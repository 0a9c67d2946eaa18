#include "tools/options/table_options.h"

#include <string>

#include "tools/options/command_options.h"

namespace spillway::command {

void add_table_options(CommandLine& app, TableOptions& options) {
  take_parsed(app.add_option("--columns", options.columns,
                             "Of text, the columns of x, y, z: as 3,2,4, as PNEZD, by names as "
                             "Easting,Northing,Height, or by characters as 1-10,11-20,21-28")
                  .value_name("LIST")
                  .group(kTableGroup),
              [](const std::string& text) {
                TextTable table;
                parse_columns(text, table);
              });
  take_whole_number(app.add_option("--skip-lines", options.skip_lines,
                                   "Of text, leave out so many lines at the top"),
                    0)
      .value_name("N")
      .group(kTableGroup);
  take_parsed(app.add_option("--separator", options.separator, "Of text, what separates columns")
                  .value_name("comma|semicolon|tab|blanks")
                  .group(kTableGroup),
              parse_separator);
  take_parsed(app.add_option("--decimal", options.decimal, "Of text, the decimal sign")
                  .value_name("point|comma")
                  .group(kTableGroup),
              parse_decimal);
  app.add_flag("--no-header", options.no_header,
               "Of text, the first line is a row, and comments name no columns")
      .group(kTableGroup);
}

}  // namespace spillway::command
