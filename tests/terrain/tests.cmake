spillway_test(terrain_test unit
  SOURCES terrain/ground_scale_test.cpp terrain/height_statistics_test.cpp terrain/line_shape_test.cpp
          terrain/line_squares_test.cpp terrain/neighbourhood_test.cpp
          terrain/overlay_volume_test.cpp terrain/pixel_cells_test.cpp terrain/pixel_values_test.cpp
          terrain/polygon_edges_test.cpp terrain/polygon_pixels_test.cpp
          terrain/polygons_of_edges_test.cpp
          terrain/triangle_pixels_test.cpp terrain/unlocated_points_test.cpp
  LIBS spillway_terrain spillway_delaunay)
