spillway_test(predicates_test unit SOURCES geometry/predicates_test.cpp LIBS spillway_geometry)
spillway_test(predicates_against_cgal_test property
  SOURCES geometry/predicates_against_cgal_test.cpp LIBS spillway_geometry CGAL::CGAL)
spillway_test(circumsphere_test unit SOURCES geometry/constructions/circumsphere_test.cpp geometry/constructions/half_space_test.cpp
          geometry/constructions/plate_test.cpp
  LIBS spillway_geometry)
spillway_test(geometry_values_test unit
  SOURCES geometry/exact_sum_test.cpp geometry/framed_point_test.cpp geometry/torus_test.cpp geometry/values_test.cpp LIBS spillway_geometry)
spillway_test(exact_constructions_test unit
  SOURCES geometry/constructions/exact_constructions_test.cpp LIBS spillway_geometry)
