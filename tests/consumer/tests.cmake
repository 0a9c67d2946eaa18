# The installed library in a program of somebody else.
if(SPILLWAY_LIBRARY)
  foreach(case shared static pkg-config fast-math headers symbols docs everything refusal subdirectory library-only)
    add_test(NAME Consumer.${case}
      COMMAND ${PROJECT_SOURCE_DIR}/tests/consumer/run.sh ${PROJECT_BINARY_DIR} ${case} ${CMAKE_CXX_COMPILER})
    set_tests_properties(Consumer.${case} PROPERTIES LABELS cli TIMEOUT 600)
  endforeach()
  if(SPILLWAY_SANITIZE)
    # The program is not built with sanitizers, so it cannot be linked with a library that is.
    set_tests_properties(Consumer.shared Consumer.static Consumer.pkg-config Consumer.fast-math
      Consumer.symbols PROPERTIES DISABLED TRUE)
  endif()
endif()
