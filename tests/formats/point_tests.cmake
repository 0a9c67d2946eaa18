spillway_test(file_system_test unit
  SOURCES formats/disk/file_system_test.cpp formats/disk/output_check_test.cpp
          formats/disk/unfinished_files_test.cpp
  LIBS spillway_formats)
spillway_test(points_test unit
  SOURCES
    formats/points/text/column_names_test.cpp
    formats/points/text/text_attributes_test.cpp
    formats/compression/compressed_text_test.cpp
    formats/points/las/las_corruption_test.cpp
    formats/disk/file_digest_test.cpp
    formats/points/las/geotiff_keys_test.cpp
    formats/points/las/las_reader_test.cpp
    formats/points/las/las_salvage_test.cpp
    formats/points/las/las_shared_data_test.cpp
    formats/points/attribute_round_trip_test.cpp
    formats/points/npy/npy_attributes_test.cpp
    formats/points/npy/npy_reader_test.cpp
    formats/points/pcd/pcd_points_test.cpp
    formats/points/ply/ply_points_test.cpp
    formats/points/invalid_rows_test.cpp
    formats/points/point_format_test.cpp
    formats/points/point_writer_test.cpp
    formats/points/text/headings_test.cpp
    formats/points/text/pts_test.cpp
    formats/points/text/text_columns_test.cpp
    formats/points/text/text_reader_test.cpp
    formats/points/text/unnamed_columns_test.cpp
  LIBS laz_encoder Boost::iostreams PkgConfig::liblz4 fmt::fmt)
spillway_test(point_fault_test fault
  SOURCES formats/points/point_fault_test.cpp
  LIBS spillway_formats fmt::fmt)
