# Random runs of the whole command against CGAL, and wrong meshes that `check` must refuse.
spillway_test_program(cgal_mesh whole/cgal_mesh.cpp)
target_link_libraries(cgal_mesh PRIVATE cgal_oracle cgal_oracle_nd)

find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  set(python ${Python3_EXECUTABLE})
  if(Python_EXECUTABLE)
    set(python ${Python_EXECUTABLE})  # one that has NumPy
  endif()
  set(driver ${python} -B ${CMAKE_CURRENT_LIST_DIR}/property_driver.py $<TARGET_FILE_DIR:spillway>)
  function(whole_test name label)
    add_test(NAME Whole.${name} COMMAND ${driver} ${ARGN})
    set_tests_properties(Whole.${name} PROPERTIES LABELS ${label} TIMEOUT 300 SKIP_RETURN_CODE 77)
  endfunction()
  whole_test(RandomRunsEqualCgal property --kind runs --cases 40 --most 2000)
  whole_test(CheckRefusesEveryWrongMesh property --kind meshes --cases 15)
  if(SPILLWAY_MPI)
    whole_test(OverRanksEqualCgal mpi --kind ranks --cases 5 --most 2000)
    # Open MPI does not free all of its memory.
    set_tests_properties(Whole.OverRanksEqualCgal PROPERTIES PROCESSORS 2 ENVIRONMENT "ASAN_OPTIONS=detect_leaks=0")
  endif()
endif()
