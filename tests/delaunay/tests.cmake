add_library(cgal_oracle STATIC delaunay/cgal_oracle.cpp)
target_link_libraries(cgal_oracle PUBLIC spillway_build PRIVATE CGAL::CGAL)

spillway_test(delaunay_unit_test unit
  SOURCES delaunay/base_case_test.cpp delaunay/divide_test.cpp delaunay/finality_test.cpp
          delaunay/parallel_test.cpp delaunay/schedule_test.cpp
  LIBS spillway_delaunay)

spillway_test(delaunay_property_test property
  SOURCES delaunay/delaunay_property_test.cpp
  LIBS spillway_delaunay spillway_generators cgal_oracle
  TIMEOUT 900)
