spillway_test(laz_decoder_test unit
  SOURCES formats/points/laz/laz_decoder_test.cpp
  LIBS spillway_formats)
