# The Python module. A file whose tests need a package that is not there is skipped, and says so.
if(SPILLWAY_PYTHON)
  foreach(group arrays attributes blocks densities dimensions docs files heights install matplotlib mesh meshio million periodic pip process products questions scipy types volumes)
    add_test(NAME Python.${group} COMMAND Python::Interpreter -B -m unittest discover -v -p test_${group}.py
      WORKING_DIRECTORY ${CMAKE_CURRENT_LIST_DIR})
    set_tests_properties(Python.${group} PROPERTIES LABELS python TIMEOUT 120
      ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python;SPILLWAY_BUILD=${PROJECT_BINARY_DIR};SPILLWAY_COMMAND=$<TARGET_FILE:spillway>"
      SKIP_REGULAR_EXPRESSION "needs (SciPy|matplotlib|meshio|mypy|python3-venv), which is not installed")
  endforeach()
  set_tests_properties(Python.million PROPERTIES LABELS "python;slow" TIMEOUT 1800)
  # It builds the library once more, for pip.
  set_tests_properties(Python.pip PROPERTIES LABELS "python;slow" TIMEOUT 1800)
endif()
