spillway_test(format_tables_test unit
  SOURCES
    formats/inputs/first_bytes_test.cpp
    formats/inputs/input_list_test.cpp
    formats/meshes/mesh_formats_test.cpp
    formats/points/point_formats_test.cpp
  LIBS spillway_formats fmt::fmt)
spillway_test(mesh_writer_test unit
  SOURCES formats/meshes/part_file_names_test.cpp formats/meshes/mesh_writer_test.cpp
  LIBS spillway_formats)
spillway_test(mesh_reader_test unit
  SOURCES formats/inputs/endless_input_test.cpp formats/meshes/mesh_corruption_test.cpp formats/meshes/mesh_reader_test.cpp
  LIBS spillway_formats)
spillway_test(polygon_test unit
  SOURCES formats/meshes/common/polygon_cutter_test.cpp formats/meshes/polygon_reader_test.cpp
  LIBS spillway_formats)
spillway_test(vtu_reader_test unit
  SOURCES formats/meshes/vtu/vtu_reader_test.cpp
  LIBS spillway_formats Boost::iostreams)
spillway_test(mesh_round_trip_test unit
  SOURCES formats/meshes/mesh_attributes_test.cpp formats/meshes/mesh_round_trip_test.cpp
  LIBS spillway_formats fmt::fmt)
spillway_test(periodic_mesh_test unit
  SOURCES formats/meshes/periodic_mesh_test.cpp
  LIBS spillway_formats fmt::fmt)
spillway_test(mesh_fault_test fault
  SOURCES formats/meshes/mesh_fault_test.cpp
  LIBS spillway_formats)
