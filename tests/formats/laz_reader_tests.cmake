spillway_test(laz_reader_test unit
  SOURCES formats/copc_test.cpp formats/laz_reader_test.cpp
  LIBS laz_encoder fmt::fmt)
spillway_test(laz_shared_data_test unit
  SOURCES formats/laz_shared_data_test.cpp
  LIBS spillway_formats fmt::fmt)
spillway_test(point_pieces_test unit
  SOURCES formats/point_pieces_test.cpp
  LIBS laz_encoder fmt::fmt)
