spillway_test(checker_test unit
  SOURCES stream/checker/checker_test.cpp
  LIBS spillway_checker cgal_oracle)
spillway_test(stream_proof_test unit
  SOURCES stream/checker/fault_text_test.cpp stream/checker/higher_dimensions_test.cpp
          stream/checker/mesh_proof_test.cpp
          stream/checker/needed_vertices_test.cpp stream/checker/stream_block_test.cpp
          stream/checker/stream_coordinates_test.cpp stream/checker/stream_proof_test.cpp
          stream/checker/whole_stream_test.cpp
  LIBS spillway_checker spillway_delaunay spillway_generators)
spillway_test(input_kind_test unit
  SOURCES formats/inputs/input_kind_test.cpp
  LIBS spillway_formats fmt::fmt)
