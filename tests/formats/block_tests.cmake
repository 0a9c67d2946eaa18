spillway_test(blocks_test unit
  SOURCES
    formats/blocks/block_test.cpp
    formats/blocks/columns_test.cpp
    formats/disk/scratch_folder_test.cpp
    formats/points/spp/spp_sorted_test.cpp
    formats/points/spp/spp_test.cpp
  LIBS spillway_formats fmt::fmt)
spillway_test(pages_test unit
  SOURCES formats/pages/relief_page_test.cpp
  LIBS spillway_formats)
spillway_test(json_test unit
  SOURCES formats/bytes/json_test.cpp formats/bytes/shared_text_test.cpp
  LIBS spillway_formats)
