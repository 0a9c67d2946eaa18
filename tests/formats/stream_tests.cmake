spillway_test(mesh_streams_test unit
  SOURCES
    formats/mesh_spool_test.cpp
    formats/sma_test.cpp
    formats/spm_part_test.cpp
    formats/spm_test.cpp
    formats/spooled_mesh_writer_test.cpp
  LIBS spillway_formats spillway_delaunay spillway_generators fmt::fmt)
