# Files of LAZ and COPC as tests need them, and what of these Spillway does not write.
add_library(laz_encoder STATIC EXCLUDE_FROM_ALL
  formats/points/copc/encoded_files.cpp formats/points/copc/point_octree.cpp
  formats/points/laz/laz_encoder/chunk_encoder.cpp
  formats/points/laz/laz_encoder/decoded_records.cpp
  formats/points/laz/laz_encoder/items_v1_encoder.cpp
  formats/points/laz/laz_encoder/laz_damage.cpp
  formats/points/laz/laz_encoder/laz_excerpt.cpp
  formats/points/laz/laz_encoder/laz_file.cpp
  formats/points/laz/laz_encoder/random_records.cpp)
target_link_libraries(laz_encoder PUBLIC spillway_formats GTest::gmock)

spillway_test(laz_test unit
  SOURCES
    formats/points/laz/laz_encoder/laz_encoder_test.cpp
    formats/points/laz/laz_records_test.cpp
    formats/points/laz/laz_round_trip_test.cpp
    formats/points/laz/laz_writer_test.cpp
  LIBS laz_encoder)
spillway_test(copc_writer_test unit
  SOURCES
    formats/points/copc/copc_faults.cpp
    formats/points/copc/copc_faults_test.cpp
    formats/points/copc/copc_writer_test.cpp
    formats/points/copc/hierarchy_pages_test.cpp
    formats/points/copc/record_lists_test.cpp
  LIBS laz_encoder fmt::fmt)
spillway_test(attributes_test unit
  SOURCES
    formats/points/attributes/record_conversion_test.cpp
    formats/points/las/records/las_attributes_test.cpp
    formats/points/spp/spp_attributes_test.cpp
  LIBS laz_encoder)
spillway_test(laz_corruption_test fault
  SOURCES
    formats/points/laz/laz_corruption_test.cpp
    formats/points/laz/laz_record_damage_test.cpp
  LIBS laz_encoder
  TIMEOUT 600)

# A driver for the whole sweep over real files; see the head of its source.
add_executable(laz_sweep EXCLUDE_FROM_ALL formats/points/laz/laz_sweep.cpp)
target_link_libraries(laz_sweep PRIVATE laz_encoder CLI11::CLI11 fmt::fmt)
