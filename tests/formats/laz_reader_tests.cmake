spillway_test(laz_reader_test unit
  SOURCES formats/points/copc/copc_test.cpp formats/points/laz/laz_reader_test.cpp
          formats/points/laz/laz_salvage_test.cpp
  LIBS laz_encoder fmt::fmt)
spillway_test(laz_shared_data_test unit
  SOURCES
    formats/points/laz/laz_encoder_shared_data_test.cpp formats/points/laz/laz_shared_data_test.cpp
  LIBS laz_encoder fmt::fmt)
spillway_test(point_pieces_test unit
  SOURCES formats/points/point_pieces_test.cpp
  LIBS laz_encoder fmt::fmt)
spillway_test(damaged_file_test fault
  SOURCES formats/inputs/damaged_file_test.cpp
  LIBS laz_encoder fmt::fmt)
