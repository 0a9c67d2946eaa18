# Compressed blocks, columns of numbers, scratch files, Spillway's own point stream, .lz4 text.
pkg_check_modules(liblz4 REQUIRED IMPORTED_TARGET GLOBAL liblz4)
target_sources(spillway_formats PRIVATE
  block.cpp
  block_stream.cpp
  columns.cpp
  lz4.cpp
  scratch_folder.cpp
  spp_format.cpp
  spp_reader.cpp
  spp_writer.cpp)
target_link_libraries(spillway_formats PRIVATE PkgConfig::liblz4 PkgConfig::xxhash)
