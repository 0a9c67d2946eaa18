spillway_test(terrain_test unit
  SOURCES terrain/pixel_values_test.cpp terrain/triangle_pixels_test.cpp
  LIBS spillway_terrain spillway_delaunay)
