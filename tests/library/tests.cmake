spillway_test(library_test property
  SOURCES library/fault_test.cpp library/higher_dimensions_test.cpp library/mesh_test.cpp library/query_test.cpp
  LIBS spillway_library spillway_generators cgal_oracle
  TIMEOUT 300)

add_library(cgal_periodic STATIC library/cgal_periodic.cpp)
target_link_libraries(cgal_periodic PUBLIC spillway_build spillway_headers PRIVATE CGAL::CGAL)

spillway_test(periodic_library_test property
  SOURCES library/periodic_mesh_test.cpp library/periodic_query_test.cpp
  LIBS spillway_library spillway_stream spillway_generators cgal_periodic
  TIMEOUT 300)
