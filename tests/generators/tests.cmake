spillway_test(generators_test unit
  SOURCES
    generators/distributions_test.cpp
    generators/degenerate_test.cpp
    generators/direction_test.cpp
    generators/every_family_test.cpp
    generators/higher_dimensions_test.cpp
    generators/packing_test.cpp
    generators/scan_test.cpp
    generators/survey_grid_test.cpp
    generators/terrain_test.cpp
  LIBS spillway_generators)
