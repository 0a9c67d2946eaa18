spillway_test(mesh_streams_test unit
  SOURCES
    formats/meshes/common/divided_block_test.cpp
    formats/meshes/common/stream_vertices_test.cpp
    formats/meshes/common/probing_table_test.cpp
    formats/meshes/common/stream_numbers_test.cpp
    formats/meshes/spool/mesh_spool_test.cpp
    formats/meshes/sma/sma_test.cpp
    formats/meshes/spool/spm_section_test.cpp
    formats/meshes/spm/spm_attributes_test.cpp
    formats/meshes/spm/spm_test.cpp
    formats/meshes/spm/spm_simplices_test.cpp
    formats/meshes/spm/spm_tetrahedra_test.cpp
    formats/meshes/spool/spooled_mesh_writer_test.cpp
  LIBS spillway_formats spillway_delaunay spillway_generators fmt::fmt)
