# The pages for users: their shell blocks run, and their pictures can be drawn. C++ is for tests/consumer, Python for
# tests/python/test_docs.py.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  set(python ${Python3_EXECUTABLE})
  if(SPILLWAY_PYTHON)
    set(python ${Python_EXECUTABLE})
  endif()
  set(pages README docs/recipes)
  if(SPILLWAY_LIBRARY AND NOT SPILLWAY_SANITIZE)
    list(APPEND pages docs/library)
  endif()
  if(SPILLWAY_PYTHON)
    list(APPEND pages docs/python)
  endif()
  foreach(page IN LISTS pages)
    cmake_path(GET page FILENAME name)
    add_test(NAME Docs.blocks_of_${name}
      COMMAND ${python} -B ${CMAKE_CURRENT_LIST_DIR}/run_blocks.py
        ${PROJECT_SOURCE_DIR}/${page}.md $<TARGET_FILE:spillway>)
    set_tests_properties(Docs.blocks_of_${name} PROPERTIES LABELS cli TIMEOUT 600 SKIP_RETURN_CODE 77
      ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python")
  endforeach()
  add_test(NAME Docs.links_between_pages_lead_somewhere
    COMMAND ${python} -B ${CMAKE_CURRENT_LIST_DIR}/links.py ${PROJECT_SOURCE_DIR})
  set_tests_properties(Docs.links_between_pages_lead_somewhere PROPERTIES LABELS cli TIMEOUT 20)
  if(SPILLWAY_PYTHON AND SPILLWAY_GDAL)
    add_test(NAME Docs.pictures_can_be_drawn COMMAND ${python} -B ${PROJECT_SOURCE_DIR}/docs/pictures/draw.py
      $<TARGET_FILE:spillway> ${CMAKE_CURRENT_BINARY_DIR}/pictures --points 1e5)
    set_tests_properties(Docs.pictures_can_be_drawn PROPERTIES LABELS cli TIMEOUT 300
      ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python" SKIP_REGULAR_EXPRESSION "No module named 'matplotlib'")
  endif()
endif()
add_test(NAME Docs.packages_agree_with_the_build COMMAND ${CMAKE_CURRENT_LIST_DIR}/packaging.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(Docs.packages_agree_with_the_build PROPERTIES LABELS cli TIMEOUT 20)
