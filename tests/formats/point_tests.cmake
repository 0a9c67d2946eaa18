spillway_test(file_system_test unit
  SOURCES formats/file_system_test.cpp formats/unfinished_files_test.cpp
  LIBS spillway_formats)
spillway_test(points_test unit
  SOURCES
    formats/column_names_test.cpp
    formats/compressed_text_test.cpp
    formats/las_corruption_test.cpp
    formats/file_digest_test.cpp
    formats/geotiff_keys_test.cpp
    formats/las_reader_test.cpp
    formats/las_shared_data_test.cpp
    formats/npy_reader_test.cpp
    formats/point_format_test.cpp
    formats/point_writer_test.cpp
    formats/pts_test.cpp
    formats/text_columns_test.cpp
    formats/text_reader_test.cpp
  LIBS laz_encoder Boost::iostreams PkgConfig::liblz4 fmt::fmt)
spillway_test(point_fault_test fault
  SOURCES formats/point_fault_test.cpp
  LIBS spillway_formats fmt::fmt)
