spillway_test(mesh_writer_test unit
  SOURCES formats/mesh_parts_test.cpp formats/mesh_writer_test.cpp
  LIBS spillway_formats)
spillway_test(mesh_reader_test unit
  SOURCES formats/endless_input_test.cpp formats/mesh_corruption_test.cpp formats/mesh_reader_test.cpp
  LIBS spillway_formats)
spillway_test(mesh_round_trip_test unit
  SOURCES formats/mesh_round_trip_test.cpp
  LIBS spillway_formats)
spillway_test(mesh_fault_test fault
  SOURCES formats/mesh_fault_test.cpp
  LIBS spillway_formats)
