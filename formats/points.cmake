# The seam to the disk, and points: LAS, text, npy.
# Zstandard is used directly: Boost's filter takes truncated data for complete.
pkg_check_modules(libzstd REQUIRED IMPORTED_TARGET libzstd)
target_sources(spillway_formats PRIVATE
  column_names.cpp
  decompress.cpp
  file_digest.cpp
  file_system.cpp
  geotiff_keys.cpp
  input_source.cpp
  las_crs.cpp
  las_header.cpp
  las_reader.cpp
  las_writer.cpp
  lattice_check.cpp
  line_reader.cpp
  naming_turn.cpp
  npy_header.cpp
  npy_reader.cpp
  npy_writer.cpp
  output_target.cpp
  point_format.cpp
  point_reader.cpp
  point_writer.cpp
  spooled_output.cpp
  text_columns.cpp
  text_opening.cpp
  text_reader.cpp
  text_writer.cpp
  unfinished_files.cpp)
target_link_libraries(spillway_formats PRIVATE PkgConfig::libzstd)
