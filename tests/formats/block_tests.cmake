spillway_test(blocks_test unit
  SOURCES
    formats/block_test.cpp
    formats/columns_test.cpp
    formats/scratch_folder_test.cpp
    formats/spp_test.cpp
  LIBS spillway_formats fmt::fmt)
