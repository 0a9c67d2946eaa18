# The programs of docs/examples, as part of this build: what they print is what tests/examples has.
# They are compiled without sanitizers, so they cannot be linked with a library that has them.
if(SPILLWAY_LIBRARY AND NOT SPILLWAY_SANITIZE)
  add_subdirectory(${PROJECT_SOURCE_DIR}/docs/examples examples)
  foreach(example mesh_in_memory locate_and_interpolate two_sinks own_source own_sink own_product dem)
    target_compile_options(example_${example} PRIVATE -Wall -Wextra -Wpedantic -Werror)
    add_test(NAME Example.${example} COMMAND ${PROJECT_SOURCE_DIR}/tests/examples/run.sh
      $<TARGET_FILE:example_${example}> ${PROJECT_SOURCE_DIR}/tests/examples/${example}.txt)
    set_tests_properties(Example.${example} PROPERTIES LABELS unit TIMEOUT 60)
  endforeach()
  set_tests_properties(Example.dem PROPERTIES SKIP_REGULAR_EXPRESSION "need GDAL, which this build")
endif()
