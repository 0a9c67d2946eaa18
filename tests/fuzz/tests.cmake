# Readers of all kinds, given bytes that may be anything: one program, whose argument chooses. Of the rooms above
# formats it has only the sources that it needs: the preset fuzz builds nothing else.
if(SPILLWAY_SANITIZE MATCHES "fuzzer")
  set(fuzz_main fuzz/libfuzzer_main.cpp)
  # Once through the seeds and some way on; run.py goes on for as long as it is told.
  set(fuzz_inputs -runs=5000 -seed=1 -rss_limit_mb=1024 -malloc_limit_mb=256 -timeout=10 -verbosity=0)
else()
  set(fuzz_main fuzz/mutation.cpp fuzz/seeded_main.cpp)
  set(fuzz_inputs --inputs=5000)
endif()
spillway_test_program(fuzz
  fuzz/block_repair.cpp
  fuzz/block_targets.cpp
  fuzz/compressed_seeds.cpp
  fuzz/file_bundle.cpp
  fuzz/foreign_seeds.cpp
  fuzz/mesh_seeds.cpp
  fuzz/mesh_targets.cpp
  fuzz/point_seeds.cpp
  fuzz/point_targets.cpp
  fuzz/program.cpp
  fuzz/target.cpp
  fuzz/text_targets.cpp
  fuzz/zstd_window.cpp
  ${fuzz_main}
  ../stream/source/condition/condition.cpp
  ../stream/source/condition/condition_parser.cpp
  ../tools/batch/job_list.cpp
  ../tools/options/former_names.cpp
  ../tools/options/input_values.cpp
  ../tools/options/table_values.cpp)
target_link_libraries(fuzz PRIVATE laz_encoder spillway_headers Boost::iostreams PkgConfig::liblz4
  PkgConfig::xxhash fmt::fmt)
if(SPILLWAY_SANITIZE MATCHES "fuzzer")
  target_link_options(fuzz PRIVATE -fsanitize=fuzzer)
endif()

# A test for each target that the program lists.
configure_file(fuzz/list_tests.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/fuzz_tests.cmake @ONLY)
file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/fuzz_program.cmake
     CONTENT "set(program $<TARGET_FILE:fuzz>)\n")
set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES
  ${CMAKE_CURRENT_BINARY_DIR}/fuzz_program.cmake ${CMAKE_CURRENT_BINARY_DIR}/fuzz_tests.cmake)
