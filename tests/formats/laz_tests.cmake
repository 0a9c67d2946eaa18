# An encoder of LAZ, which only tests need.
add_library(laz_encoder STATIC EXCLUDE_FROM_ALL
  formats/laz_encoder/arithmetic_encoder.cpp
  formats/laz_encoder/chunk_encoder.cpp
  formats/laz_encoder/gps_time_encoder.cpp
  formats/laz_encoder/integer_compressor.cpp
  formats/laz_encoder/item_encoder.cpp
  formats/laz_encoder/laz_damage.cpp
  formats/laz_encoder/laz_excerpt.cpp
  formats/laz_encoder/laz_file.cpp
  formats/laz_encoder/point10_encoder.cpp
  formats/laz_encoder/point14_encoder.cpp
  formats/laz_encoder/random_records.cpp
  formats/laz_encoder/rgb_encoder.cpp)
target_link_libraries(laz_encoder PUBLIC spillway_formats GTest::gmock)

spillway_test(laz_test unit
  SOURCES formats/laz_encoder/laz_encoder_test.cpp formats/laz_round_trip_test.cpp
  LIBS laz_encoder)
spillway_test(laz_corruption_test fault
  SOURCES formats/laz_corruption_test.cpp
  LIBS laz_encoder
  TIMEOUT 600)

# A driver for the whole sweep over real files; see the head of its source.
add_executable(laz_sweep EXCLUDE_FROM_ALL formats/laz_sweep.cpp)
target_link_libraries(laz_sweep PRIVATE laz_encoder CLI11::CLI11 fmt::fmt)
