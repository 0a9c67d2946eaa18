spillway_test(picture_test unit
  SOURCES picture/legend_test.cpp picture/line_layer_test.cpp picture/polygons_test.cpp picture/relief_test.cpp
          picture/tetrahedron_cut_test.cpp picture/tilted_test.cpp
  LIBS spillway_picture)
