spillway_test(library_test property
  SOURCES library/fault_test.cpp library/higher_dimensions_test.cpp library/mesh_test.cpp library/query_test.cpp
  LIBS spillway_library spillway_generators cgal_oracle
  TIMEOUT 300)
