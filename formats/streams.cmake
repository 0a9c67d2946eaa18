# Meshes block by block: spm, sma, and the spool for formats whose headers come first.
target_sources(spillway_formats PRIVATE
  mesh_block.cpp
  mesh_spool.cpp
  mesh_stream_reader.cpp
  mesh_stream_writer.cpp
  sma_reader.cpp
  sma_writer.cpp
  spm_block.cpp
  spm_corners.cpp
  spm_part.cpp
  spm_reader.cpp
  spm_writer.cpp
  spooled_mesh_writer.cpp)
